// Functions that pages share: elements, vectors, and encoded sRGB (IEC 61966-2-1) of linear values in [0, 1].
const byId = id => document.getElementById(id);
const dot = (first, second) => first.reduce((sum, value, i) => sum + value * second[i], 0);
const multiply = (matrix, vector) => matrix.map(row => dot(row, vector));
const encode = linear => (linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055);
const hexOfCodes = codes => "#" + codes.map(code => code.toString(16).padStart(2, "0")).join("");

function createSvg(tag, attributes, ...children) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

