// Hovering over a marker tells what stands for it, and finds the same method in every panel.
const rows = JSON.parse(document.getElementById("rows").textContent);
const tip = document.getElementById("tip");
const picture = document.querySelector(".picture svg");
const parts = new Map(rows.map((_, row) => [row, []]));
for (const part of picture.querySelectorAll('[id^="marker-"], [id^="whisker-"], [id^="label-"]')) {
  const row = Number(part.id.split("-")[2]);
  parts.get(row).push(part);
  part.addEventListener("pointerenter", event => show(row, event));
  part.addEventListener("pointermove", follow);
  part.addEventListener("pointerleave", hide);
}
function show(row, event) {
  const { title, lines } = rows[row];
  const list = document.createElement("dl");
  for (const [name, told] of lines) {
    const term = document.createElement("dt");
    const value = document.createElement("dd");
    term.textContent = name;
    value.textContent = told;
    if (!name) value.className = "wide";
    list.append(...(name ? [term, value] : [value]));
  }
  const head = document.createElement("b");
  head.textContent = title;
  tip.replaceChildren(head, list);
  tip.hidden = false;
  picture.classList.add("dim");
  parts.get(row).forEach(part => part.classList.add("hot"));
  follow(event);
}
function follow(event) {
  const { innerWidth, innerHeight } = window;
  const left = event.clientX + 18 + tip.offsetWidth > innerWidth ? event.clientX - 18 - tip.offsetWidth : event.clientX + 18;
  tip.style.left = `${Math.max(left, 4)}px`;
  tip.style.top = `${Math.max(4, Math.min(event.clientY + 12, innerHeight - tip.offsetHeight - 4))}px`;
}
function hide() {
  tip.hidden = true;
  picture.classList.remove("dim");
  picture.querySelectorAll(".hot").forEach(part => part.classList.remove("hot"));
}
for (const box of document.querySelectorAll(".families input")) {
  box.addEventListener("change", () => {
    rows.forEach(({ family }, row) => {
      if (family === box.value) parts.get(row).forEach(part => part.classList.toggle("gone", !box.checked));
    });
  });
}
