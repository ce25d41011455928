// The form of a new study: bounds are suggested for the place that is chosen, each method shows its own fields, and
// what the study takes is estimated while the form is filled in.
const form = document.querySelector("[data-new-study]"), estimate = form.querySelector("[data-estimate]");
const PAUSE = 500; // after the last change, before the estimate is asked for [ms]

for (const line of form.querySelectorAll("[data-vary]")) {
  const choice = line.querySelector("select"), [low, high] = ["low", "high"].map((end) => line.querySelector(`[name^="${end}."]`));
  choice.addEventListener("change", () => {
    const { low: least = "", high: largest = "" } = choice.selectedOptions[0].dataset;
    low.value = least;
    high.value = largest;
    showRelation(line);
  });
  showRelation(line);
}

// What is set aside if a value that a relation sets is varied, and what could be varied instead.
function showRelation(line) {
  const choice = line.querySelector("select"), words = line.querySelector("[data-aside]");
  const { relation, instead = "" } = choice.selectedOptions[0].dataset;
  words.hidden = !relation;
  if (!relation) return;
  const names = instead.split(" ").filter(Boolean);
  words.replaceChildren(`The relation ${choice.value} ${relation} is set aside in this study. `, ...names.flatMap((name) => [other(choice, name), " "]));
}

function other(choice, name) {
  const button = document.createElement("button");
  Object.assign(button, { type: "button", textContent: `Keep it, and vary ${name}` });
  button.addEventListener("click", () => {
    choice.value = name;
    choice.dispatchEvent(new Event("change", { bubbles: true }));
  });
  return button;
}

function showOwn() {
  const method = form.elements.method.value;
  for (const part of form.querySelectorAll("[data-for]")) part.hidden = !part.dataset.for.split(" ").includes(method);
}

let pause, asked = new AbortController();

function askSoon() {
  clearTimeout(pause);
  if (form.querySelector("[data-vary] select").value) pause = setTimeout(ask, PAUSE);
}

async function ask() {
  asked.abort();
  asked = new AbortController();
  const body = new URLSearchParams(new FormData(form)), button = form.querySelector("[data-ask]");
  try {
    const answer = await fetch(`${button.formAction}?part=true`, { method: "POST", body, signal: asked.signal });
    if (answer.ok) estimate.innerHTML = await answer.text();
  } catch (error) {
    if (error.name !== "AbortError") throw error;
  }
}

// Of many outputs those whose name or words hold all that is typed; a ticked one stays in sight.
const MANY = 12, more = form.querySelector("[data-more]"), boxes = [...more.querySelectorAll("[data-words]")];
const narrow = more.querySelector("[data-narrow]"), typed = narrow.querySelector("input");
narrow.hidden = boxes.length <= MANY;
typed.addEventListener("input", () => {
  const wanted = typed.value.toLowerCase().split(/\s+/).filter(Boolean);
  for (const box of boxes) box.hidden = !box.querySelector("input").checked && !wanted.every((word) => box.dataset.words.includes(word));
  for (const group of more.querySelectorAll("[data-group]")) group.hidden = !group.querySelector("[data-words]:not([hidden])");
  more.querySelector("[data-narrowed]").textContent = `${boxes.filter((box) => !box.hidden).length} of ${boxes.length}`;
});
typed.addEventListener("keydown", (event) => {
  if (event.key === "Enter") event.preventDefault(); // it filters; it does not start the study
});

form.querySelector("[data-ask]").hidden = true; // it is asked for by itself
form.addEventListener("change", () => {
  showOwn();
  askSoon();
});
showOwn();
askSoon();
