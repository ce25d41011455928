// The placeholder of a list names the suggestions that are as long as the other lists along its axis.
const FEW = 2; // suggestions in a placeholder
const length = (text) => (text.match(/[0-9]+([.,][0-9]+)?/g) ?? []).length;

export function startSuggestions(form = document) {
  const lists = [...form.querySelectorAll("input[data-along]")];
  const fit = (field) => {
    const others = lists.filter((one) => one !== field && one.dataset.along === field.dataset.along);
    const count = Math.max(...others.map(({ value }) => length(value)), 0);
    const alike = [...field.list.options].filter(({ value }) => length(value) === count).slice(0, FEW);
    field.placeholder = alike.map(({ value, text }) => `${value} (${text})`).join(", ") || field.dataset.hint;
  };
  const open = lists.filter(({ list }) => list);
  for (const field of open) field.dataset.hint = field.placeholder;
  const all = () => open.forEach(fit);
  form.addEventListener("input", all);
  all();
}
