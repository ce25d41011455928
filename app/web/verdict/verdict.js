// The verdict at the top of the design page and in the summary lines of its steps, which the server renders.
import { fetched, foldOf } from "../shared/later.js";
import { quantityText } from "../shared/numbers.js";
import { reveal } from "../shared/reveal.js";

const place = document.querySelector("[data-verdict]");
let newest = 0; // number of the newest request; older responses are ignored

// Return a verdict and its criteria as parts of a page; null if a newer one was requested meanwhile.
export async function drawnVerdict({ verdict, criteria }) {
  const number = (newest += 1), design = document.querySelector("[data-design]")?.dataset.design ?? "";
  const body = JSON.stringify({ verdict, criteria, design });
  const answer = await fetch("/verdicts", { method: "POST", headers: { "Content-Type": "application/json" }, body });
  if (!answer.ok) throw new Error(`answer ${answer.status}`);
  const drawn = new DOMParser().parseFromString(await answer.text(), "text/html");
  return number === newest ? drawn : null;
}

// Show a verdict and its criteria; for a design without criteria nothing changes.
export async function showVerdict({ verdict, criteria = [] }) {
  if (!verdict || criteria.length === 0) return;
  const drawn = await drawnVerdict({ verdict, criteria }).catch(refuse);
  if (!drawn) return;
  const banner = drawn.querySelector("[data-tone]"), all = banner.querySelector("[data-all-criteria]");
  place.classList.remove("green", "bad", "open", "plain");
  place.classList.add(banner.dataset.tone);
  const decide = document.querySelector("[data-decide]");
  if (decide) decide.hidden = banner.dataset.wanted === undefined;
  all.open = Boolean(place.querySelector("[data-all-criteria]")?.open);
  for (const part of ["[data-verdict-bar]", "[data-verdict-rest]"]) place.querySelector(part).replaceChildren(...banner.querySelector(part).childNodes);
  for (const line of document.querySelectorAll("[data-fold-verdict]")) {
    const worst = drawn.querySelector(`[data-fold-verdict="${CSS.escape(line.dataset.foldVerdict)}"]`);
    line.replaceChildren(...(worst?.childNodes ?? []));
  }
}

// The previous verdict is no longer valid.
function refuse(error) {
  place.classList.remove("green", "bad", "open", "plain");
  place.querySelector("[data-verdict-rest]").replaceChildren();
  place.querySelector("[data-verdict-bar]").textContent = `The verdict could not be loaded: ${error.message}`;
}

// Show the key results of a step in its summary line.
export function showKeys(step, { outputs = {} }) {
  for (const [name, quantity] of Object.entries(outputs)) {
    const key = document.querySelector(`[data-key="${step}.${name}"]`);
    if (key) key.textContent = quantityText(quantity).replaceAll("_", " ");
  }
}

// A link in the verdict opens its target; the page leaves room for the verdict above it, and for the part.
export function startVerdict(form) {
  leaveRoom("--verdict", place.querySelector("[data-verdict-bar]"));
  leaveRoom("--picture", document.querySelector(".part-view"));
  followLinks(place, form);
  rememberFolds(`folds:${form.dataset.design}`);
}

// Return the height of the part that stays in view, so that it does not cover the target of a key or link.
function leaveRoom(name, box) {
  const measure = () => document.body.style.setProperty(name, `${box.offsetHeight}px`);
  if (box) new ResizeObserver(measure).observe(box);
}

// A missing input links to its field, the name of a criterion to its step.
export function followLinks(criteria, form) {
  criteria.addEventListener("click", (event) => {
    const target = event.target.closest("[data-give], [data-reveal]");
    if (!target) return;
    const { give } = target.dataset;
    const leadsTo = give ? fieldOf(form, give) : document.getElementById(target.hash.slice(1));
    const fold = give && !leadsTo && foldOf(give.split(".")[0]);
    if (!leadsTo && !fold) return;
    event.preventDefault();
    if (leadsTo) goTo(leadsTo);
    else fetched(fold).then(() => goTo(fieldOf(form, give) ?? fold));
  });
}

export function goTo(leadsTo) {
  reveal(leadsTo);
  leadsTo.focus();
  leadsTo.scrollIntoView({ block: leadsTo.matches("input, select") ? "center" : "start" });
}

// Return the field of an input or a limit; on the page of a template both have bare names.
export function fieldOf(form, name) {
  const [block, ...tail] = name.split(".");
  const controls = [name, `.${name}`, `limits.${name}`, `${block}@limits.${tail.join(".")}`];
  return [...form.querySelectorAll("input, select")].find((field) => controls.includes(field.name));
}

// The tab of the browser remembers which steps the user folded or unfolded; refused fields stay visible.
function rememberFolds(key) {
  const kept = JSON.parse(sessionStorage.getItem(key) ?? "{}");
  for (const fold of document.querySelectorAll("[data-fold]")) {
    const name = fold.dataset.fold, isRefused = fold.querySelector("[aria-invalid]") !== null;
    if (Object.hasOwn(kept, name)) fold.open = kept[name] || isRefused;
    fold.querySelector("summary").addEventListener("click", () => {
      kept[name] = !fold.open;
      sessionStorage.setItem(key, JSON.stringify(kept));
    });
  }
}
