// The table of variants: add an empty row once the last is used, and paste blocks from a spreadsheet.
const form = document.querySelector("[data-variants]");
const LAST = 202; // largest row number of the sheet
const address = /^cell\.([A-Z]+)([0-9]+)$/;

// Return the fields of a row by column, in the order of the page.
const fieldsOf = (row) => [...row.querySelectorAll("input[name^='cell.']")];
const rows = () => [...form.querySelectorAll("tr[data-row]")];

// Add an empty row below, whose fields are named after the next row of the sheet.
function addRow() {
  const last = rows().at(-1), number = Number(last.dataset.row) + 1;
  if (number > LAST) return null;
  const row = last.cloneNode(true);
  row.removeAttribute("id");
  row.classList.remove("governs");
  row.dataset.row = number;
  row.querySelectorAll(".field-error, .tag, button").forEach((part) => part.remove());
  for (const field of fieldsOf(row)) {
    const [, column] = field.name.match(address);
    Object.assign(field, { name: `cell.${column}${number}`, id: `${column}${number}`, value: "" });
    field.removeAttribute("aria-invalid");
    field.removeAttribute("aria-describedby");
  }
  last.after(row);
  return row;
}

// Show the unit of a new column, which applies to its values without a unit.
function showUnit({ target }) {
  if (!target.matches(".heading")) return;
  const words = target.value.trim().toLowerCase().split(/\s+/).join("_");
  const named = [...form.querySelectorAll("#variant-places option")].filter(({ value }) => value === target.value || value.toLowerCase().replace(/^.*\./, "") === words);
  const unit = named.length === 1 ? named[0].dataset.unit : "";
  target.closest("th").querySelector(".unit").placeholder = unit && unit !== "1" ? unit : "unit";
}

function changed() {
  if (fieldsOf(rows().at(-1)).some((field) => field.value.trim())) addRow();
  form.querySelector("[data-variants-state]").textContent = "not saved";
}

// Return a block of cells as spreadsheets copy it: line breaks end rows, tabs end cells.
function paste(event) {
  const text = event.clipboardData.getData("text/plain").replace(/\r\n?/g, "\n").replace(/\n$/, "");
  const start = event.target.closest("tr[data-row]");
  if (!/[\t\n]/.test(text) || !start) return;
  event.preventDefault();
  const place = fieldsOf(start).indexOf(event.target);
  let row = start;
  for (const line of text.split("\n")) {
    if (!row) break;
    const fields = fieldsOf(row);
    line.split("\t").forEach((cell, at) => {
      if (fields[place + at]) fields[place + at].value = cell.trim();
    });
    row = row.nextElementSibling ?? addRow();
  }
  changed();
}

if (form) {
  form.addEventListener("input", changed);
  form.addEventListener("input", showUnit);
  form.addEventListener("paste", paste);
  for (const upload of document.querySelectorAll("[data-variants-file]")) {
    upload.querySelector("input[type=file]").addEventListener("change", () => upload.requestSubmit());
  }
}

// Sort the table of results by a column; numbers by value, words in alphabetical order, empty cells last.
function sort(table, head) {
  const ascending = head.getAttribute("aria-sort") !== "ascending";
  table.querySelectorAll("[aria-sort]").forEach((other) => other.removeAttribute("aria-sort"));
  head.setAttribute("aria-sort", ascending ? "ascending" : "descending");
  const at = [...head.parentNode.children].indexOf(head), sign = ascending ? 1 : -1;
  const key = (row) => row.children[at].dataset.number ?? row.children[at].textContent.trim();
  const lines = [...table.tBodies[0].rows].sort((one, other) => {
    const [a, b] = [key(one), key(other)], [x, y] = [Number(a), Number(b)];
    if (Number.isFinite(x) && Number.isFinite(y) && a !== "" && b !== "") return sign * (x - y);
    return sign * a.localeCompare(b);
  });
  table.tBodies[0].append(...lines);
}

// Return a table as a spreadsheet takes it from the clipboard: tabs between cells, numbers with all digits.
function copied(table) {
  const text = (cell) => cell.dataset.number ?? cell.textContent.trim().replace(/\s+/g, " ");
  return [...table.rows].map((row) => [...row.cells].map(text).join("\t")).join("\n");
}

for (const table of document.querySelectorAll("[data-sortable]")) {
  for (const head of table.tHead.rows[0].cells) {
    const button = document.createElement("button");
    button.type = "button";
    button.append(...head.childNodes);
    head.append(button);
    button.addEventListener("click", () => sort(table, head));
  }
  const copy = table.closest("section").querySelector("[data-copy-table]");
  if (copy && navigator.clipboard) {
    copy.hidden = false;
    copy.addEventListener("click", async () => {
      await navigator.clipboard.writeText(copied(table));
      copy.parentNode.querySelector("[data-copied]").textContent = "copied";
    });
  }
}
