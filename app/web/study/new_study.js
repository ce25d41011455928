// The form for a new study: it suggests bounds for the chosen quantity, shows the fields of the chosen method, and
// estimates the time of the study while the user fills it in.
const form = document.querySelector("[data-new-study]"), estimate = form.querySelector("[data-estimate]");
const PAUSE = 500; // pause after the last change before the estimate is requested [ms]

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

// Name the relation that is ignored if its value is varied, and the values that could be varied instead.
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

// Show only the outputs whose name or words contain the typed text; ticked outputs stay visible.
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
  if (event.key === "Enter") event.preventDefault(); // Enter must not start the study
});

form.querySelector("[data-ask]").hidden = true; // the estimate is requested automatically
form.addEventListener("change", () => {
  showOwn();
  askSoon();
});
showOwn();
askSoon();
