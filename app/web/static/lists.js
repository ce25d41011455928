// Fields of lists and curves: their buttons open a dialog that edits the items, or takes a pasted table.
import { startItems } from "./items.js";
import { startPasting } from "./pasting.js";

export function startLists(root = document) {
  const edit = startItems(root.querySelector("[data-items-dialog]"));
  const paste = startPasting(root.querySelector("[data-paste-dialog]"));
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

// Set a field as if it were typed: the page previews it, and keeps it as a draft.
export function fill(field, text) {
  field.value = text;
  field.dispatchEvent(new Event("input", { bubbles: true }));
}

// What a dialog needs: Cancel closes it, and its keys are none of the page's, which saves with Ctrl+S.
export function asDialog(dialog) {
  dialog.addEventListener("keydown", (event) => event.stopPropagation());
  for (const button of dialog.querySelectorAll("[data-close]")) button.addEventListener("click", () => dialog.close());
  return (selector) => dialog.querySelector(selector);
}
