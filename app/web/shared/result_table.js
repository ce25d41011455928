// Tables of results: sort by a column if all rows are on the page, and copy into a spreadsheet.

export function startTables() {
  for (const table of document.querySelectorAll(".results-table:not([data-started])")) {
    table.dataset.started = "";
    if (table.dataset.sortable !== undefined) makeSortable(table);
    offerCopy(table);
  }
}

function makeSortable(table) {
  for (const head of table.tHead.rows[0].cells) {
    const button = document.createElement("button");
    button.type = "button";
    button.append(...head.childNodes);
    head.append(button);
    button.addEventListener("click", () => sort(table, head));
  }
}

// Sort by a column: numbers by value, words in alphabetical order, cells without a value last.
function sort(table, head) {
  const ascending = head.getAttribute("aria-sort") !== "ascending";
  table.querySelectorAll("[aria-sort]").forEach((other) => other.removeAttribute("aria-sort"));
  head.setAttribute("aria-sort", ascending ? "ascending" : "descending");
  const sign = ascending ? 1 : -1, key = (row) => valueOf(row.cells[head.cellIndex]);
  const lines = [...table.tBodies[0].rows].sort((one, other) => {
    const [a, b] = [key(one), key(other)];
    if (a === "" || b === "") return (a === "") - (b === "");
    return sign * (typeof a === "number" && typeof b === "number" ? a - b : String(a).localeCompare(String(b)));
  });
  table.tBodies[0].append(...lines);
}

function valueOf({ dataset, textContent }) {
  const text = textContent.trim();
  return dataset.number !== undefined ? Number(dataset.number) : text === "–" ? "" : text;
}

function offerCopy(table) {
  const copy = table.closest("section").querySelector("[data-copy-table]");
  if (!copy || !navigator.clipboard) return;
  copy.hidden = false;
  copy.addEventListener("click", async () => {
    await navigator.clipboard.writeText(copied(table));
    copy.parentNode.querySelector("[data-copied]").textContent = "copied";
  });
}

// Return a table as a spreadsheet takes it from the clipboard: tabs between cells, numbers with all digits.
function copied(table) {
  const text = (cell) => cell.dataset.number ?? cell.textContent.trim().replace(/\s+/g, " ");
  const cells = (row) => [...row.cells].filter((cell) => !cell.matches(".screen-only"));
  return [...table.rows].map((row) => cells(row).map(text).join("\t")).join("\n");
}

startTables();
