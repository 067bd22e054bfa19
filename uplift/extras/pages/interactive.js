// Hovering over a marker shows its tooltip and highlights the same row in every panel.
const rows = JSON.parse(document.getElementById("rows").textContent);
const tip = document.getElementById("tip");
const picture = document.querySelector(".panels");
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
  for (const [name, text] of lines) {
    const term = document.createElement("dt");
    const value = document.createElement("dd");
    term.textContent = name;
    value.textContent = text;
    if (!name) value.className = "wide";
    list.append(...(name ? [term, value] : [value]));
  }
  const head = document.createElement("b");
  head.textContent = title;
  tip.replaceChildren(head, list);
  tip.hidden = false;
  picture.classList.add("dimmed");
  parts.get(row).forEach(part => part.classList.add("highlighted"));
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
  picture.classList.remove("dimmed");
  picture.querySelectorAll(".highlighted").forEach(part => part.classList.remove("highlighted"));
}
// A page with choices shows the parts whose values are all chosen.
const choices = [...document.querySelectorAll(".choice input")];
function choose() {
  const chosen = new Set(choices.filter(input => input.checked).map(input => input.value));
  for (const part of document.querySelectorAll("[data-choice]")) {
    part.hidden = !part.dataset.choice.split(" ").every(value => chosen.has(value));
  }
}
if (choices.length) choose();
choices.forEach(input => input.addEventListener("change", choose));
for (const box of document.querySelectorAll(".families input")) {
  box.addEventListener("change", () => {
    rows.forEach(({ family }, row) => {
      if (family === box.value) parts.get(row).forEach(part => part.classList.toggle("hidden", !box.checked));
    });
  });
}
