// Drawing of the regions in a* and b*, and of the spectrum.
const PLOT = { left: 38, right: 294, top: 6, bottom: 262 };
const CURVE = { left: 8, right: 312, top: 8, bottom: 104 };
const PIXELS = 96;
const MIN_EXTENT = 5;
const NEARLY = 0.999;
const byId = id => document.getElementById(id);

function createSvg(tag, attributes, ...children) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

// A square of a* and b* around the region, and its map to the plot.
function scaleOf(points) {
  const low = [0, 1].map(axis => Math.min(...points.map(point => point[axis])));
  const high = [0, 1].map(axis => Math.max(...points.map(point => point[axis])));
  const half = Math.max(0.56 * Math.max(high[0] - low[0], high[1] - low[1]), MIN_EXTENT / 2);
  const middle = [0, 1].map(axis => (low[axis] + high[axis]) / 2);
  const unit = (PLOT.right - PLOT.left) / (2 * half);
  return {
    half,
    middle,
    toPlot: ([a, b]) => [PLOT.left + unit * (a - middle[0] + half), PLOT.bottom - unit * (b - middle[1] + half)],
    toAb: ([x, y]) => [(x - PLOT.left) / unit + middle[0] - half, (PLOT.bottom - y) / unit + middle[1] - half],
  };
}

const pathOf = points => points.map(point => point.map(value => value.toFixed(2)).join(" ")).join("L");

function drawRegion(number, light, scale, answer, luminance) {
  const outline = `M${pathOf(light.region.map(scale.toPlot))}Z`;
  const clip = createSvg("clipPath", { id: `clip-${number}` }, createSvg("path", { d: outline }));
  const side = PLOT.right - PLOT.left;
  const box = { x: PLOT.left, y: PLOT.top, width: side, height: side };
  const colours = createSvg("image", { ...box, href: colourImage(light, scale, answer[0], luminance), "clip-path": `url(#clip-${number})` });
  const parts = [clip, ...drawAxes(scale), colours, createSvg("path", { d: outline, class: "outline" })];
  if (light.likely) parts.push(createSvg("path", { d: `M${pathOf(light.likely.map(scale.toPlot))}Z`, class: "likely" }));
  const [x, y] = scale.toPlot(answer.slice(1));
  parts.push(createSvg("path", { d: `M${x - 5} ${y}h10M${x} ${y - 5}v10`, class: "answer" }));
  parts.push(createSvg("circle", { id: `goal-${number}`, r: 9, class: "goal" }));
  parts.push(createSvg("circle", { id: `point-${number}`, r: 4.5, class: "point" }));
  byId(`region-${number}`).append(...parts);
}

// Colours of one lightness over a* and b*.
function colourImage(light, scale, lightness, luminance) {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = PIXELS;
  const context = canvas.getContext("2d");
  const image = context.createImageData(PIXELS, PIXELS);
  const step = (2 * scale.half) / PIXELS;
  for (let row = 0; row < PIXELS; row++)
    for (let column = 0; column < PIXELS; column++) {
      const a = scale.middle[0] - scale.half + step * (column + 0.5);
      const b = scale.middle[1] + scale.half - step * (row + 0.5);
      const rgb = linearRgb(light, labToXyz([lightness, a, b], light.white));
      image.data.set([...toCodes(rgb, luminance), 255], 4 * (row * PIXELS + column));
    }
  context.putImageData(image, 0, 0);
  return canvas.toDataURL();
}

function drawAxes(scale) {
  const step = [1, 2, 5, 10, 20, 50, 100].find(each => (2 * scale.half) / each <= 6);
  const parts = [];
  for (const axis of [0, 1]) {
    const [low, high] = [scale.middle[axis] - scale.half, scale.middle[axis] + scale.half];
    for (let value = Math.ceil(low / step) * step; value <= high; value += step) {
      const point = axis ? [scale.middle[0], value] : [value, scale.middle[1]];
      const [x, y] = scale.toPlot(point);
      parts.push(createSvg("path", { d: axis ? `M${PLOT.left} ${y}H${PLOT.right}` : `M${x} ${PLOT.top}V${PLOT.bottom}`, class: "grid-line" }));
      const at = axis ? { x: PLOT.left - 5, y: y + 3, "text-anchor": "end" } : { x, y: PLOT.bottom + 13, "text-anchor": "middle" };
      parts.push(createSvg("text", at, String(value).replace("-", "−")));
    }
  }
  parts.push(createSvg("text", { x: PLOT.right, y: PLOT.bottom - 5, "text-anchor": "end" }, "a*"));
  parts.push(createSvg("text", { x: PLOT.left + 4, y: PLOT.top + 9 }, "b*"));
  return parts;
}

function curve(wavelengths, reflectance) {
  const { left, right, top, bottom } = CURVE;
  const step = (right - left) / (wavelengths.at(-1) - wavelengths[0]);
  const points = reflectance.map((value, i) => [left + step * (wavelengths[i] - wavelengths[0]), bottom - (bottom - top) * value]);
  return `M${pathOf(points)}`;
}

// A point, or where the segment from `inside` to it nearly leaves the polygon.
function clampToPolygon(point, polygon, inside) {
  let share = 1;
  const [dx, dy] = [point[0] - inside[0], point[1] - inside[1]];
  polygon.forEach((first, i) => {
    const second = polygon[(i + 1) % polygon.length];
    const [ex, ey] = [second[0] - first[0], second[1] - first[1]];
    const [fx, fy] = [first[0] - inside[0], first[1] - inside[1]];
    const cross = dx * ey - dy * ex;
    if (!cross) return;
    const along = (fx * ey - fy * ex) / cross;
    const across = (fx * dy - fy * dx) / cross;
    if (across >= 0 && across <= 1 && along > 0) share = Math.min(share, along);
  });
  return share < 1 ? [inside[0] + NEARLY * share * dx, inside[1] + NEARLY * share * dy] : point;
}
