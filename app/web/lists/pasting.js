// The dialog for a pasted table or a CSV file: the service reads it, the user assigns columns to fields.
import { call } from "../shared/api.js";
import { isolated } from "../shared/isolated.js";
import { asDialog, fill } from "./dialogs.js";
import { live } from "../shared/live.js";

const LARGEST = 4_000_000; // of a file [bytes]

export function startPasting(dialog) {
  const find = asDialog(dialog);
  const text = find("[data-paste-text]"), offset = find("[data-paste-offset]"), apply = find("[data-paste-apply]");
  let lists = [], answer = null, chosen = null, signature = "", file = "";

  const reading = live(
    (signal) => call("POST", "/tables", asked(), { signal }),
    ({ payload }) => show(payload),
    (error) => refuse([...(error.faults?.values() ?? [])].join("; ") || error.message),
  );

  function asked() {
    const fields = lists.map(({ name, words, unit, symbol }) => ({ name, words, unit, symbol }));
    return { text: file ? "" : text.value, file, fields, columns: chosen, offset: offset.value };
  }

  function ask() {
    apply.disabled = true;
    find("[data-paste-state]").textContent = "";
    if (file || text.value.trim()) reading.ask();
    else show({ columns: [], first: [], rows: 0, notes: [], faults: [] });
  }

  function show(payload) {
    answer = payload;
    tell(payload.faults ?? []);
    const preview = find("[data-paste-preview]"), isSame = signature === JSON.stringify(payload.columns.map(({ name }) => name));
    preview.hidden = !payload.columns.length;
    if (!isSame || !chosen) preview.replaceChildren(table(payload));
    else preview.querySelector("tbody").replaceWith(body(payload));
    signature = JSON.stringify(payload.columns.map(({ name }) => name));
    apply.disabled = !Object.keys(payload.texts ?? {}).length;
    apply.textContent = apply.disabled ? "Insert" : `Insert ${payload.rows} rows`;
    const assumed = payload.assumed?.length ? [`Assumed: ${payload.assumed.join(", ")}.`] : [];
    find("[data-paste-state]").replaceChildren(isolated([...(payload.notes ?? []), ...assumed].join(" ")));
  }

  function table({ columns, first, rows }) {
    const all = document.createElement("table"), head = document.createElement("thead");
    all.createCaption().textContent = "Columns and first rows";
    head.append(
      line("th", columns.map(({ name }) => name)),
      line("td", columns.map(({ name, unit }) => named("input", { value: unit, placeholder: "unit", autocomplete: "off" }, `Unit of ${name}`))),
      line("td", columns.map(({ name, field }) => goesTo(name, field))),
    );
    all.append(head, body({ first, rows }));
    return all;
  }

  function body({ first, rows }) {
    const part = document.createElement("tbody");
    part.append(...first.map((row) => line("td", row.map(String))));
    if (rows > first.length) part.append(line("td", [`… ${rows} rows in all`]));
    return part;
  }

  function goesTo(name, field) {
    const select = named("select", {}, `Field for ${name}`);
    select.append(new Option("not taken", ""), ...lists.map((list) => new Option(list.words, list.name, false, list.name === field)));
    return select;
  }

  function tell(faults) {
    const notice = find("[data-paste-faults]"), items = document.createElement("ul");
    items.append(...faults.map((fault) => {
      const item = document.createElement("li");
      item.append(isolated(fault));
      return item;
    }));
    notice.replaceChildren(items);
    notice.hidden = !faults.length;
  }

  function refuse(words) {
    apply.disabled = true;
    find("[data-paste-preview]").hidden = true;
    tell([words]);
  }

  text.addEventListener("input", () => {
    chosen = null;
    file = "";
    ask();
  });
  offset.addEventListener("input", ask);
  find("[data-paste-preview]").addEventListener("input", () => {
    const [units, fields] = ["thead input", "thead select"].map((which) => [...dialog.querySelectorAll(which)]);
    chosen = fields.map((field, place) => ({ field: field.value, unit: units[place].value.trim() }));
    ask();
  });
  find("[data-paste-file]").addEventListener("change", async ({ target }) => {
    const [sent] = target.files;
    if (!sent) return;
    if (sent.size > LARGEST) return refuse(`${sent.name} is ${Math.round(sent.size / 1e6)} MB in size; a table may be at most ${LARGEST / 1e6} MB`);
    file = await inBase64(sent);
    text.value = "";
    chosen = null;
    ask();
  });
  apply.addEventListener("click", () => {
    dialog.close();
    for (const { name, field } of lists) if (Object.hasOwn(answer.texts, name)) fill(field, answer.texts[name]);
    lists.find(({ name }) => Object.hasOwn(answer.texts, name)).field.focus();
  });

  return (list, all) => {
    lists = [list, ...all.filter((other) => other !== list)];
    text.value = offset.value = find("[data-paste-file]").value = file = "";
    chosen = null;
    ask();
    dialog.showModal();
    text.focus();
  };
}

function line(kind, cells) {
  const row = document.createElement("tr");
  for (const cell of cells) {
    const field = Object.assign(document.createElement(kind), kind === "th" ? { scope: "col" } : {});
    field.append(cell);
    row.append(field);
  }
  return row;
}

function named(kind, properties, label) {
  const control = Object.assign(document.createElement(kind), properties);
  control.setAttribute("aria-label", label);
  return control;
}

function inBase64(file) {
  return new Promise((resolve, reject) => {
    const reader = new FileReader();
    reader.onload = () => resolve(reader.result.slice(reader.result.indexOf(",") + 1));
    reader.onerror = () => reject(reader.error);
    reader.readAsDataURL(file);
  });
}
