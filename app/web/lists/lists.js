// Fields of lists and curves: their buttons open a dialog to edit the items, or to paste a table.
import { startItems } from "./items.js";
import { startPasting } from "./pasting.js";

let edit, paste; // functions that open the page's two dialogs

export function startLists(root = document) {
  edit ??= startItems(document.querySelector("[data-items-dialog]"));
  paste ??= startPasting(document.querySelector("[data-paste-dialog]"));
  const all = [...root.querySelectorAll("[data-list]")].map(listOf);
  for (const list of all) {
    list.tools.hidden = false;
    list.tools.querySelector("[data-edit-items]").addEventListener("click", () => edit(list));
    list.tools.querySelector("[data-paste-table]").addEventListener("click", () => paste(list, all.filter((other) => other.block === list.block)));
  }
}

function listOf(tools) {
  const { list: name, words, unit, symbol } = tools.dataset;
  const block = name.includes(".") ? name.split(".")[0] : "";
  return { tools, name, words, unit, symbol, block, field: tools.parentElement.querySelector("input") };
}
