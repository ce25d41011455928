// The form of a new study: bounds are suggested for the place that is chosen, and each method shows its own fields.
const form = document.querySelector("[data-new-study]");

for (const line of form.querySelectorAll("[data-vary]")) {
  const choice = line.querySelector("select"), [low, high] = ["low", "high"].map((end) => line.querySelector(`[name^="${end}."]`));
  choice.addEventListener("change", () => {
    const { low: least = "", high: largest = "" } = choice.selectedOptions[0].dataset;
    low.value = least;
    high.value = largest;
  });
}

function showOwn() {
  const method = form.elements.method.value;
  for (const part of form.querySelectorAll("[data-for]")) part.hidden = !part.dataset.for.split(" ").includes(method);
}

form.addEventListener("change", showOwn);
showOwn();
