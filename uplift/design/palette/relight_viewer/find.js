// Which material is where: a name pointed at dims all else in the picture; a place pointed at tells its material.
const mask = byId("mask").getContext("2d");
const names = [...document.querySelectorAll("[data-material]")];
let kept = 0;

function find(number) {
  const veil = mask.createImageData(mask.canvas.width, mask.canvas.height);
  const over = new Uint32Array(veil.data.buffer);
  if (number) labels.forEach((label, p) => (over[p] = label === number ? 0 : 0xd0202020));
  mask.putImageData(veil, 0, 0);
  mark(number);
}

function mark(number) {
  names.forEach((button, i) => button.closest("tr").classList.toggle("found", i + 1 === number));
  byId("pointed").textContent = number ? materials[number - 1] : "";
}

names.forEach((button, i) => {
  const row = button.closest("tr");
  row.addEventListener("pointerenter", () => find(i + 1));
  row.addEventListener("pointerleave", () => find(kept));
  button.addEventListener("click", () => {
    kept = kept === i + 1 ? 0 : i + 1;
    names.forEach((other, j) => other.setAttribute("aria-pressed", j + 1 === kept));
    find(kept);
  });
});

const view = byId("mask");
view.addEventListener("pointermove", ({ offsetX, offsetY }) => {
  const column = Math.floor((offsetX * view.width) / view.clientWidth);
  const row = Math.floor((offsetY * view.height) / view.clientHeight);
  mark(labels[Math.min(row, view.height - 1) * view.width + Math.min(column, view.width - 1)] || kept);
});
view.addEventListener("pointerleave", () => mark(kept));
