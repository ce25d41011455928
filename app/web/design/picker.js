// A dialog with every name that a relation may use, by block, with values; a button beside each field opens it.
import { insert, isRelation, startOfName } from "./names.js";
import { unit } from "../shared/numbers.js";

const ROLES = { parameter: "", input: "input", output: "", measure: "measured" };

export function startPicker(form, names) {
  const dialog = document.querySelector("[data-picker]");
  const [filter, only, groups, count] = ["filter", "only", "groups", "count"].map((name) => dialog.querySelector(`[data-${name}]`));
  let field = null, range = [0, 0];

  function open(target) {
    field = target;
    range = [target.selectionStart, target.selectionEnd];
    const dimension = names.dimensionOf(field);
    only.checked = dimension !== undefined;
    dialog.querySelector("[data-only-label]").hidden = dimension === undefined;
    dialog.querySelector("[data-only-label] span").textContent = `only what fits${names.unitOf(field) ? ` (${names.unitOf(field)})` : ""}`;
    filter.value = "";
    fill();
    dialog.showModal();
    filter.focus();
  }

  function fill() {
    const shown = names.matching(field, filter.value.trim()).filter((item) => !only.checked || names.fits(item, field));
    groups.replaceChildren(...grouped(shown).map(group));
    count.textContent = shown.length ? `${shown.length} ${shown.length === 1 ? "value" : "values"}` : "nothing fits";
  }

  function take(name) {
    dialog.close();
    const [caret, end] = range;
    const start = caret === end ? startOfName(field.value, caret) : caret;
    if (isRelation(field.value)) insert(field, name, start < 0 ? afterSign(caret) : start, Math.max(end, afterSign(end)));
    else insert(field, name, 0, 0);
  }

  const afterSign = (place) => Math.max(place, field.value.indexOf("=") + 1);

  filter.addEventListener("input", fill);
  only.addEventListener("change", fill);
  filter.addEventListener("keydown", (event) => {
    if (event.key !== "Enter" && event.key !== "ArrowDown") return;
    event.preventDefault(); // Enter would close the dialog
    const first = groups.querySelector("button");
    if (event.key === "Enter") first?.click();
    else first?.focus();
  });
  groups.addEventListener("keydown", (event) => {
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (!step) return;
    event.preventDefault();
    const all = [...groups.querySelectorAll("button")], next = all.indexOf(document.activeElement) + step;
    (next < 0 ? filter : all[next])?.focus();
  });
  groups.addEventListener("click", (event) => {
    const button = event.target.closest("[data-pick]");
    if (button) take(button.dataset.pick);
  });
  const watchAll = (fields) => {
    for (const input of [...fields].filter((one) => names.takes(one))) addButton(input, () => open(input));
  };
  watchAll(form.elements);
  return watchAll; // for fields added later
}

function addButton(input, open) {
  const around = Object.assign(document.createElement("span"), { className: "pick-around" });
  const button = Object.assign(document.createElement("button"), { type: "button", className: "pick", textContent: "=", tabIndex: -1, title: "Choose a value (Alt+↓)", ariaLabel: "Choose a value" });
  button.dataset.pickFor = input.name;
  const label = input.labels[0];
  if (label) {
    label.id ||= `${input.id}-label`;
    button.setAttribute("aria-describedby", label.id);
  }
  input.replaceWith(around);
  around.append(input, button);
  button.addEventListener("click", open);
  input.addEventListener("keydown", (event) => {
    if (!event.altKey || event.key !== "ArrowDown") return;
    event.preventDefault();
    open();
  });
}

// Group by block, parameters first, in the order of the names; inputs follow the outputs of a block.
function grouped(items) {
  const blocks = new Map();
  for (const item of items) {
    const block = item.role === "parameter" ? "Parameters" : item.name.split(".")[0];
    if (!blocks.has(block)) blocks.set(block, { block, computed: [], inputs: [] });
    blocks.get(block)[item.role === "input" ? "inputs" : "computed"].push(item);
  }
  return [...blocks.values()];
}

function group({ block, computed, inputs }, place) {
  const head = element("h3", { id: `picker-${place}`, textContent: block });
  const section = element("section", {}, head, element("ul", {}, ...[...computed, ...inputs].map(line)));
  section.setAttribute("aria-labelledby", head.id);
  return section;
}

function line(item) {
  const tail = item.role === "parameter" ? item.name : item.name.slice(item.name.indexOf(".") + 1);
  const words = [item.words, ROLES[item.role]].filter((text, place) => text && !(place && item.words.endsWith(text))).join(", ");
  const button = element("button", { type: "button" }, element("code", { textContent: tail }), element("span", { className: "value", textContent: item.value || unit(item.unit) }), element("small", { textContent: words }));
  button.dataset.pick = item.name;
  return element("li", {}, button);
}

function element(tag, properties, ...inside) {
  const node = Object.assign(document.createElement(tag), properties);
  node.append(...inside);
  return node;
}
