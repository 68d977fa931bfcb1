"use strict";
// Sorts a table by its headers; rows without a value stay below the others.
function value(row, column) {
  const text = row.cells[column].textContent.trim();
  if (text === "" || text === "–") return null;
  const number = Number(text.replace(/^</, ""));
  return Number.isNaN(number) ? text : text.startsWith("<") ? number / 4 : number;
}
const words = new Intl.Collator("en", { numeric: true });
function compare(a, b) {
  if (typeof a === "number" && typeof b === "number") return a - b;
  return words.compare(String(a), String(b));
}
function sort(table, header, column) {
  const up = header.getAttribute("aria-sort") !== "ascending";
  for (const other of header.parentElement.cells) other.removeAttribute("aria-sort");
  header.setAttribute("aria-sort", up ? "ascending" : "descending");
  const keyed = Array.from(table.tBodies[0].rows, (row, place) => ({ row, place, key: value(row, column) }));
  keyed.sort((a, b) => {
    if (a.key === null || b.key === null) return (a.key === null) - (b.key === null) || a.place - b.place;
    return (up ? 1 : -1) * compare(a.key, b.key) || a.place - b.place;
  });
  table.tBodies[0].append(...keyed.map((item) => item.row));
}
for (const table of document.querySelectorAll("table.rows")) {
  Array.from(table.querySelectorAll(".names th")).forEach((header, column) => {
    if (header.classList.contains("plain")) return;
    const button = document.createElement("button");
    button.type = "button";
    button.append(...header.childNodes);
    button.addEventListener("click", () => sort(table, header, column));
    header.append(button);
  });
  const tools = document.createElement("p");
  tools.className = "tools";
  const filter = document.createElement("input");
  filter.type = "search";
  filter.placeholder = "show rows with all of these words: size = 1024 linear";
  filter.setAttribute("aria-label", filter.placeholder);
  filter.addEventListener("input", () => {
    const wanted = filter.value.toLowerCase().split(/\s+/).filter(Boolean);
    for (const row of table.tBodies[0].rows) {
      const text = [1, 2, 3].map((cell) => row.cells[cell].textContent).join(" ").toLowerCase();
      row.hidden = !wanted.every((word) => text.includes(word));
    }
  });
  tools.append(filter);
  table.parentElement.before(tools);
}
for (const code of document.querySelectorAll(".card pre")) {
  if (!navigator.clipboard) break;
  const button = document.createElement("button");
  button.type = "button";
  button.className = "copy";
  button.textContent = "Copy";
  button.addEventListener("click", () => {
    navigator.clipboard.writeText(code.textContent).then(() => { button.textContent = "Copied"; });
  });
  code.after(button);
}
