// The verdict on top of the design page and in the fold lines of its steps; the server writes it.
import { fetched, foldOf } from "../shared/later.js";
import { quantityText } from "../shared/numbers.js";
import { reveal } from "../shared/reveal.js";

const place = document.querySelector("[data-verdict]");
let newest = 0; // of the verdicts that were asked for: an older one comes too late

// A verdict and its criteria as parts of a page; null if a newer one was asked for meanwhile.
export async function drawnVerdict({ verdict, criteria }) {
  const number = (newest += 1), design = document.querySelector("[data-design]")?.dataset.design ?? "";
  const body = JSON.stringify({ verdict, criteria, design });
  const answer = await fetch("/verdicts", { method: "POST", headers: { "Content-Type": "application/json" }, body });
  if (!answer.ok) throw new Error(`answer ${answer.status}`);
  const drawn = new DOMParser().parseFromString(await answer.text(), "text/html");
  return number === newest ? drawn : null;
}

// Show a verdict and its criteria; of a design without criteria nothing changes.
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
  place.querySelector("[data-verdict-inside]").replaceChildren(...banner.childNodes);
  for (const line of document.querySelectorAll("[data-fold-verdict]")) {
    const worst = drawn.querySelector(`[data-fold-verdict="${CSS.escape(line.dataset.foldVerdict)}"]`);
    line.replaceChildren(...(worst?.childNodes ?? []));
  }
}

// What stood there before is no longer so.
function refuse(error) {
  place.classList.remove("green", "bad", "open", "plain");
  place.querySelector("[data-verdict-inside]").textContent = `The verdict could not be fetched: ${error.message}`;
}

// The key results of a step in its fold line.
export function showKeys(step, { outputs = {} }) {
  for (const [name, quantity] of Object.entries(outputs)) {
    const key = document.querySelector(`[data-key="${step}.${name}"]`);
    if (key) key.textContent = quantityText(quantity).replaceAll("_", " ");
  }
}

// A link of the verdict opens what it leads to; the page leaves room for the verdict above it, and for the part.
export function startVerdict(form) {
  leaveRoom("--verdict", place);
  leaveRoom("--picture", document.querySelector(".part-view"));
  followLinks(place, form);
  rememberFolds(`folds:${form.dataset.design}`);
}

// The height of what stays in view: what a key or a link leads to must not lie behind it.
function leaveRoom(name, box) {
  const measure = () => document.body.style.setProperty(name, `${box.offsetHeight}px`);
  if (box) new ResizeObserver(measure).observe(box);
}

// What is missing leads to its field, the name of a criterion to its step.
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

// The field of an input, or of a limit; on the page of a template both have bare names.
export function fieldOf(form, name) {
  const [block, ...tail] = name.split(".");
  const controls = [name, `.${name}`, `limits.${name}`, `${block}@limits.${tail.join(".")}`];
  return [...form.querySelectorAll("input, select")].find((field) => controls.includes(field.name));
}

// Which steps the user folded or unfolded is kept by the tab of the browser; what was refused stays in view.
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
