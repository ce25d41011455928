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
