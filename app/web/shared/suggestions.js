// The placeholder of a list names the suggestions with as many items as the lists beside it.
const FEW = 2; // suggestions in a placeholder
const count = (text) => (text.match(/[0-9]+([.,][0-9]+)?/g) ?? []).length;

export function startSuggestions(root = document) {
  for (const field of root.querySelectorAll("input[data-beside]")) {
    const names = field.dataset.beside.split(" "), usual = field.placeholder;
    const beside = names.map((name) => field.form.elements.namedItem(name)).filter(Boolean);
    const fit = () => {
      const items = Math.max(...beside.map(({ value }) => count(value)), 0);
      const alike = [...field.list.options].filter(({ value }) => count(value) === items).slice(0, FEW);
      field.placeholder = alike.map(({ value, text }) => `${value} (${text})`).join(", ") || usual;
    };
    for (const other of beside) other.addEventListener("input", fit);
    fit();
  }
}
