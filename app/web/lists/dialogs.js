// Functions that the dialogs which fill a field share.

// Set a field as if the user had typed it, so that the page previews it and keeps it as a draft.
export function fill(field, text) {
  field.value = text;
  field.dispatchEvent(new Event("input", { bubbles: true }));
}

// Set up a dialog: Cancel closes it, and its keys do not reach the page, which saves with Ctrl+S.
export function asDialog(dialog) {
  dialog.addEventListener("keydown", (event) => event.stopPropagation());
  for (const button of dialog.querySelectorAll("[data-close]")) button.addEventListener("click", () => dialog.close());
  return (selector) => dialog.querySelector(selector);
}
