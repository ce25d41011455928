// What the dialogs that fill a field share.

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
