// The dialog that edits a list item by item: quantities and relations, side by side.
import { asDialog, fill } from "./dialogs.js";
import { valueOf } from "../shared/typed.js";

const MOST_ITEMS = 500;
const NUMBER = /^([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,3})?)\s*(.*)$/s;

// Return the items of a text such as `[1, 2] mm` or `["= a", "3 mm"]`; null for a table of several rows.
export function itemsOf(text) {
  const value = valueOf(text);
  if (value === "") return [];
  const inside = value?.value ?? value, unit = value?.unit;
  const all = Array.isArray(inside) ? inside : [inside];
  if (all.some(Array.isArray)) return null;
  return all.map((item) => written(item, unit));
}

function written(item, unit) {
  if (item !== null && typeof item === "object") return written(item.value, item.unit);
  return typeof item === "number" && unit && unit !== "1" ? `${item} ${unit}` : String(item);
}

// Return items as the text of a field: numbers of one unit as `[1, 2] mm`, others one by one.
export function textOf(items) {
  const filled = items.map((item) => item.trim()).filter(Boolean);
  if (!filled.length) return "";
  const parts = filled.map((item) => item.match(NUMBER));
  const units = new Set(parts.map((part) => part?.[2]));
  if (parts.every(Boolean) && units.size === 1) return [JSON.stringify(parts.map(([, number]) => Number(number))), ...units].join(" ").trim();
  return JSON.stringify(filled.map((item, place) => (parts[place]?.[2] === "" ? Number(item) : item)));
}

export function startItems(dialog) {
  const find = asDialog(dialog), place = find("[data-items]");
  let list;

  function add(text, before = null) {
    const line = document.createElement("li"), row = document.createElement("div"), input = document.createElement("input");
    const remove = Object.assign(document.createElement("button"), { type: "button", textContent: "Remove" });
    Object.assign(input, { value: text, autocomplete: "off", spellcheck: false, placeholder: `quantity or = relation` });
    row.append(input, remove);
    line.append(row);
    place.insertBefore(line, before);
    remove.addEventListener("click", () => removed(line));
    input.addEventListener("keydown", (event) => {
      if (event.key !== "Enter") return;
      event.preventDefault();
      add("", line.nextSibling);
    });
    number();
    input.focus();
  }

  function removed(line) {
    const next = line.nextElementSibling ?? line.previousElementSibling;
    line.remove();
    number();
    (next?.querySelector("input") ?? find("[data-items-add]")).focus();
  }

  function number() {
    [...place.children].forEach((line, index) => {
      line.querySelector("input").setAttribute("aria-label", `Item ${index + 1}`);
      line.querySelector("button").setAttribute("aria-label", `Remove item ${index + 1}`);
    });
    find("[data-items-state]").textContent = `${place.children.length} items`;
  }

  find("[data-items-add]").addEventListener("click", () => add(""));
  find("[data-items-apply]").addEventListener("click", () => {
    dialog.close();
    const items = [...place.querySelectorAll("input")].map((input) => input.value);
    fill(list.field, isWhole(list.field.value, items) ? items[0].trim() : textOf(items));
    list.field.focus();
  });

  return (chosen) => {
    list = chosen;
    const items = itemsOf(list.field.value), isLong = items?.length > MOST_ITEMS;
    place.replaceChildren();
    find("#items-title").textContent = `Items of ${list.words}`;
    find("[data-items-example]").textContent = list.unit === "1" ? "3" : `3 ${list.unit}`;
    const isShown = items !== null && !isLong;
    for (const button of dialog.querySelectorAll("[data-items-add], [data-items-apply]")) button.disabled = !isShown;
    dialog.showModal();
    number();
    if (!isShown) return (find("[data-items-state]").textContent = isLong ? `${items.length} values are too many to edit one by one; paste a table instead.` : "This is a table with several rows; edit it in its field.");
    for (const item of items.length ? items : [""]) add(item);
    place.querySelector("input").focus();
  };
}

// A single relation for the whole list, such as `= load.crank_angle`, stays unchanged.
const isWhole = (before, items) => items.length === 1 && /^\s*=/.test(before) && items[0].trim().startsWith("=");
