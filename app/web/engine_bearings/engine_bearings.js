// Check the entries while the user types: the service answers with the page, of which the live parts are taken.
const form = document.querySelector("[data-engine]");
const file = form.querySelector("[name=diagram]");
const table = form.querySelector("[name=diagram_table]");
const PAUSE = 400; // ms
let timer = 0, asked = null;

form.addEventListener("input", (event) => later(event.target));
form.addEventListener("change", (event) => later(event.target));
file.addEventListener("change", () => {
  if (file.files.length) form.elements.gas.value = "diagram"; // whoever chooses a diagram wants it to be used
});
table.addEventListener("input", () => (file.value = "")); // an edited table replaces the file from which it came

function later(changed) {
  clearTimeout(timer);
  timer = setTimeout(() => check(changed), PAUSE);
}

async function check(changed) {
  asked?.abort();
  asked = new AbortController();
  const body = new FormData(form);
  body.set("wanted", "check");
  try {
    const answer = await fetch(form.getAttribute("action"), { method: "POST", body, signal: asked.signal });
    if (answer.ok) show(new DOMParser().parseFromString(await answer.text(), "text/html"), changed);
  } catch (error) {
    if (error.name !== "AbortError") throw error;
  }
}

function show(page, changed) {
  if (changed === file && page.querySelector("[data-live='diagram.assumed']").textContent) {
    table.value = page.querySelector("[name=diagram_table]").value;
  }
  const offers = form.querySelector("[data-live=proposals]"), fresh = page.querySelector("[data-live=proposals]");
  if (names(offers) !== names(fresh)) takeOffers(offers, fresh);
  for (const part of form.querySelectorAll("[data-live]:not([data-live=proposals])")) {
    const now = page.querySelector(`[data-live="${part.dataset.live}"]`);
    if (now) take(part, now);
  }
}

function take(part, now) {
  part.replaceChildren(...now.childNodes);
  part.hidden = now.hidden;
  if (!part.dataset.live.startsWith("error.")) return;
  const field = form.elements[part.dataset.live.slice("error.".length)];
  if (part.hidden) field?.removeAttribute("aria-invalid");
  else field?.setAttribute("aria-invalid", "true");
}

function takeOffers(old, fresh) {
  const open = [...old.querySelectorAll("details[open]")].map(({ dataset }) => dataset.group);
  old.replaceChildren(...fresh.childNodes);
  for (const group of old.querySelectorAll("details")) group.open ||= open.includes(group.dataset.group);
}

const names = (part) => [...part.querySelectorAll("input")].map((field) => `${field.name} ${field.placeholder}`).join();
