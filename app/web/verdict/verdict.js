// The verdict on top of the design page and in the fold lines of its steps, as pages/verdict.html writes them.
import { compared, error, isOpen, margin, missing, remarks, share, stepOf, tagOf, title, verdictWords } from "./criteria.js";
import { isolated } from "../shared/isolated.js";
import { fetched, foldOf } from "../shared/later.js";
import { quantityText } from "../shared/numbers.js";
import { reveal } from "../shared/reveal.js";

const TONES = { not_met: "bad", undecided: "open", not_checked: "open" };
const MOST_UNCHECKED = 3;
const SVG = "http://www.w3.org/2000/svg";
const HEADS = ["Criterion", "Verdict", "Value and limit", "Used", "Margin", "Error"];

const place = document.querySelector("[data-verdict]");
const capital = (text) => text.charAt(0).toUpperCase() + text.slice(1);

function element(tag, properties, ...inside) {
  const node = Object.assign(document.createElement(tag), properties);
  node.append(...inside);
  return node;
}

// Show a verdict and its criteria; of a design without criteria nothing changes.
export function showVerdict({ verdict, criteria = [] }) {
  if (!verdict || criteria.length === 0) return;
  place.classList.remove("green", "bad", "open", "plain");
  place.classList.add(verdict.green ? "green" : TONES[verdict.verdict] ?? "plain");
  const decide = document.querySelector("[data-decide]");
  if (decide) decide.hidden = !criteria.some(isOpen);
  const isUnfolded = place.querySelector("[data-all-criteria]")?.open;
  place.querySelector("[data-verdict-inside]").replaceChildren(...banner(verdict, criteria, isUnfolded));
  for (const line of document.querySelectorAll("[data-fold-verdict]")) {
    const worst = criteria.find((criterion) => stepOf(criterion) === line.dataset.foldVerdict);
    line.replaceChildren(...(worst ? [tag(worst), ` ${share(worst.utilisation)}`] : []));
  }
}

// The key results of a step in its fold line.
export function showKeys(step, { outputs = {} }) {
  for (const [name, quantity] of Object.entries(outputs)) {
    const key = document.querySelector(`[data-key="${step}.${name}"]`);
    if (key) key.textContent = quantityText(quantity).replaceAll("_", " ");
  }
}

function banner(verdict, criteria, isUnfolded) {
  const governing = criteria.find(({ name }) => name === verdict.governing);
  const head = element("div", { className: "verdict-line" }, element("h2", { className: "headline", id: "verdict" }, capital(verdict.headline)));
  if (governing) head.append(governs(governing));
  const unchecked = criteria.filter((criterion) => criterion.verdict === "not_checked");
  const all = element("details", { open: Boolean(isUnfolded) }, element("summary", {}, `All ${criteria.length} criteria`), criteriaTable(criteria));
  all.dataset.allCriteria = "";
  return [head, ...(unchecked.length ? [notChecked(unchecked)] : []), all];
}

function governs(criterion) {
  const node = element("p", { className: "governing" }, tag(criterion), " governing: ", element("strong", {}, link(criterion)), ` ${compared(criterion)}`);
  const used = share(criterion.utilisation), left = margin(criterion), off = error(criterion);
  if (used) node.append(" ", element("span", { className: "used" }, bar(criterion), ` ${used} used`));
  node.append(left && `; margin ${left}`, off && `; error ${off}`, criterion.unverified ? "; the limit is unverified" : "", ...why(criterion));
  return node;
}

function notChecked(unchecked) {
  const node = element("p", { className: "unchecked" }, "Not checked: ");
  unchecked.slice(0, MOST_UNCHECKED).forEach((criterion, place) => node.append(place ? "; " : "", link(criterion), " (", ...give(criterion), ")"));
  if (unchecked.length > MOST_UNCHECKED) node.append(` and ${unchecked.length - MOST_UNCHECKED} more`);
  return node;
}

function give(criterion) {
  if (!criterion.give?.length) return [isolated(missing(criterion))];
  const links = criterion.give.flatMap((name, place) => {
    const node = element("a", { href: "#sheet" }, name.split(".").at(-1).replaceAll("_", " "));
    node.dataset.give = name;
    return place ? [", ", node] : [node];
  });
  return ["give ", ...links];
}

function link(criterion) {
  const step = stepOf(criterion);
  if (!step) return capital(title(criterion));
  const node = element("a", { href: `#step-${step}` }, `${step}: ${title(criterion)}`);
  node.dataset.reveal = "";
  return node;
}

// Where the verdict of a saved design comes from; a template's page has no such address.
function why({ name }) {
  const design = document.querySelector("[data-design]")?.dataset.design;
  const title = "where this verdict comes from";
  return design ? [" ", element("a", { className: "why", href: `/designs/${design}/explain/${name}`, title }, "why?")] : [];
}

const tag = (criterion) => element("span", { className: `tag ${tagOf(criterion)}` }, verdictWords(criterion));

export function criteriaTable(criteria) {
  const head = element("thead", {}, element("tr", {}, ...HEADS.map((text) => element("th", { scope: "col" }, text))));
  const node = element("table", { className: "criteria" }, head, element("tbody", {}, ...criteria.map(row)));
  return element("div", { className: "scroll", tabIndex: 0, role: "region", ariaLabel: "All criteria" }, node);
}

function row(criterion) {
  const said = remarks(criterion).flatMap((text) => [" ", element("span", { className: "muted remark" }, isolated(text))]);
  const cells = [
    element("th", { scope: "row" }, link(criterion), ...why(criterion)), element("td", {}, tag(criterion)),
    element("td", {}, `${compared(criterion)} `, ...give(criterion), ...said),
    element("td", { className: "used" }, share(criterion.utilisation), ...[bar(criterion)].filter(Boolean)),
    element("td", {}, margin(criterion)), element("td", {}, error(criterion)),
  ];
  const node = element("tr", {}, ...cells);
  node.dataset.criterion = criterion.name;
  return node;
}

// The mark is the limit; the whole bar is 150 % of it.
function bar(criterion) {
  const { utilisation } = criterion;
  if (typeof utilisation !== "number") return "";
  const node = drawn("svg", { class: `bar ${tagOf(criterion)}`, viewBox: "0 0 150 10", preserveAspectRatio: "none", role: "img", "aria-label": `${share(utilisation)} of the limit` });
  const used = Math.min(150, Math.max(0, utilisation * 100));
  node.append(drawn("rect", { class: "track", width: 150, height: 10 }), drawn("rect", { class: "used", width: used, height: 10 }), drawn("path", { class: "mark", d: "M100,0V10" }));
  return node;
}

function drawn(name, attributes) {
  const node = document.createElementNS(SVG, name);
  for (const [attribute, value] of Object.entries(attributes)) node.setAttribute(attribute, value);
  return node;
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
