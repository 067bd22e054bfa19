// Highlighting: pointing at a name dims the other materials in the picture; pointing at the picture shows the name.
const mask = byId("mask").getContext("2d");
const names = [...document.querySelectorAll("[data-material]")];
let pinned = 0;

function highlight(number) {
  const overlay = mask.createImageData(mask.canvas.width, mask.canvas.height);
  const pixels32 = new Uint32Array(overlay.data.buffer);
  if (number) labels.forEach((label, p) => (pixels32[p] = label === number ? 0 : 0xd0202020));
  mask.putImageData(overlay, 0, 0);
  showName(number);
}

function showName(number) {
  names.forEach((button, i) => button.closest("tr").classList.toggle("highlighted", i + 1 === number));
  byId("pointed").textContent = number ? materials[number - 1] : "";
}

names.forEach((button, i) => {
  const row = button.closest("tr");
  row.addEventListener("pointerenter", () => highlight(i + 1));
  row.addEventListener("pointerleave", () => highlight(pinned));
  button.addEventListener("click", () => {
    pinned = pinned === i + 1 ? 0 : i + 1;
    names.forEach((other, j) => other.setAttribute("aria-pressed", j + 1 === pinned));
    highlight(pinned);
  });
});

const view = byId("mask");
view.addEventListener("pointermove", ({ offsetX, offsetY }) => {
  const column = Math.floor((offsetX * view.width) / view.clientWidth);
  const row = Math.floor((offsetY * view.height) / view.clientHeight);
  showName(labels[Math.min(row, view.height - 1) * view.width + Math.min(column, view.width - 1)] || pinned);
});
view.addEventListener("pointerleave", () => showName(pinned));
