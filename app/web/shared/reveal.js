// Open the folds that hide a field.
export function reveal(field) {
  for (let hides = field.closest("details"); hides; hides = hides.parentElement.closest("details")) hides.open = true;
}
