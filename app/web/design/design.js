// The script of the design page: previews, the draft, saving, progress. Every action calls the API.
import { Refused, call, units } from "../shared/api.js";
import { calculated } from "../shared/calculation.js";
import { startDownloads } from "../shared/downloads.js";
import { startCompletion } from "../shared/completion.js";
import { Draft } from "../shared/draft.js";
import { startDrives } from "./drives.js";
import { isolated } from "../shared/isolated.js";
import { startLater } from "../shared/later.js";
import { startLists } from "../lists/lists.js";
import { startSuggestions } from "../shared/suggestions.js";
import { live } from "../shared/live.js";
import { Names } from "./names.js";
import { OwnLines, namesOf } from "./own_lines.js";
import { showParameters, showValues } from "./parameters.js";
import { startPicker } from "./picker.js";
import { drawPictures } from "../plots/pictures.js";
import { follow } from "../shared/progress.js";
import { OUTDATED, markOutdated, markWaiting, showFaults, showResults, showWarnings } from "../shared/results.js";
import { startSolids } from "../solid/solids.js";
import { startDecide } from "./decide.js";
import { startTolerances } from "../tolerances/tolerances.js";
import { nameOf, patchOf } from "../shared/typed.js";
import { goTo, showKeys, showVerdict, startVerdict } from "../verdict/verdict.js";

startDownloads();
startLists();
startSuggestions();

const form = document.getElementById("sheet");
const { design: id, revision } = form.dataset;
const api = `/api/v1/designs/${id}`;
const namesHere = document.querySelector("[data-names]").value; // for a long design they are fetched
const names = new Names(JSON.parse(namesHere || "[]"));
const lines = new OwnLines(document.querySelector("[data-own-lines]"), names);
const watches = []; // functions that set up fields added later
const draft = new Draft(form, JSON.parse(form.querySelector("[name=was]").value));
const models = new Set([...document.querySelectorAll("[data-model]")].map((part) => part.dataset.model));
const state = form.querySelector("[data-state]");
const trouble = form.querySelector("[data-trouble]");
const OWN = `own:${id}`; // the revision that another form of this page saves
const MOST_LINKS = 5; // largest number of links to wrong fields
const CONFLICT = 409; // the calculation was cancelled
const patch = () => patchOf(draft.changed(), models);
const progress = document.querySelector("[data-progress]");
const designState = document.querySelector("[data-design-state]").dataset.designState;
const isJudged = document.querySelector("[data-verdict]").dataset.verdict === "judged"; // the revision has a verdict
const ofVariants = document.querySelector("[data-governing-variant]"); // the governing variant as saved
let steps = {}, rounded = new Map(), conflicted = false, isFollowing = false; // the bar shows the job of a revision

const preview = live(
  (signal) => previewed(signal, isFollowing),
  ({ payload }) => {
    clear();
    for (const notice of document.querySelectorAll("[data-sent-fault]")) notice.hidden = true; // it concerned the form as sent
    show(payload);
    state.textContent = [draft.keep() && "previewed, not saved", waiting(payload)].filter(Boolean).join("; ");
  },
  refusePreview,
);

// Show fast results at once and slow ones when their job has ended; or only the fast ones.
async function previewed(signal, isQuick) {
  const path = `${api}/preview?worksheet=true&units=${units()}${isQuick ? "&within=1" : ""}`;
  const answer = await call("POST", path, patch(), { signal, headers: { Prefer: "wait=1" } });
  if (answer.status !== 202) return answer;
  clear();
  show(answer.payload);
  state.textContent = draft.keep() ? "not saved" : "";
  return calculated(answer.location, signal);
}

// Mark a step that is not calculated yet; while nothing is changed, the page shows the results of the revision.
const isWaiting = (answer) => answer.state === "pending" && (designState !== "current" || draft.isChanged());

// The page has the verdict and the lines of the saved revision; a preview without some of its steps knows less.
const knowsLess = () => designState === "current" && !draft.isChanged() && Object.values(steps).some(({ state }) => state === "pending");

function waiting({ steps }) {
  const names = Object.keys(steps).filter((step) => isWaiting(steps[step]));
  return names.length > 0 && `${names.join(", ")} not calculated yet`;
}

function show(payload) {
  steps = payload.steps;
  rounded = new Map((payload.rounded ?? []).map((row) => [row.name, row]));
  names.update(payload);
  if (!knowsLess()) lines.show(payload);
  ofVariants?.classList.toggle("outdated", draft.isChanged());
  if ((isJudged || draft.isChanged()) && !knowsLess()) showVerdict(payload);
  for (const [step, answer] of Object.entries(steps)) {
    markWaiting(step, isWaiting(answer));
    if (answer.state === "pending") continue;
    showResults(step, answer);
    showKeys(step, answer);
    showValues(form, step, answer, rounded);
    drawPictures(document, step, answer);
  }
  showValues(form, "", { inputs: payload.parameters }, rounded);
  showWarnings("", payload.warnings.filter(isOfNoStep));
  showParameters(payload.model_parameters, rounded);
}

// Warnings on the design's own parameters and its models; those of a step are shown in the step.
const isOfNoStep = ({ name }) => !Object.hasOwn(steps, name.split(".")[0]);

function clear() {
  progress.hidden = !isFollowing;
  showFaults(form, new Map());
  markOutdated(false);
  trouble.hidden = !conflicted;
}

function refusePreview(error) {
  progress.hidden = !isFollowing;
  refuse(error);
  markOutdated(true);
  state.append(state.textContent ? "; " : "", OUTDATED);
}

function refuse(error) {
  state.textContent = "";
  if (!(error instanceof Refused)) return tell(`The service does not answer: ${error.message}`);
  const loose = showFaults(form, lines.takeFaults(error.faults));
  if (error.status !== CONFLICT) state.replaceChildren("not accepted: see the message beside ", ...linksToFaults());
  if (loose.size || !error.faults.size) tell([...loose.values()].join("; ") || error.message);
}

// Links to the wrong fields; for a fault without a field, a text.
function linksToFaults() {
  const links = [...form.querySelectorAll('[aria-invalid="true"]')].slice(0, MOST_LINKS).flatMap((field, place) => {
    const link = Object.assign(document.createElement("a"), { href: `#${field.id}`, textContent: nameOf(field.name).replaceAll("_", " ") });
    link.addEventListener("click", (event) => {
      event.preventDefault();
      goTo(field);
    });
    return place ? [", ", link] : [link];
  });
  return links.length ? links : ["the field"];
}

function tell(words) {
  trouble.replaceChildren(isolated(words));
  trouble.hidden = false;
}

function showDraft() {
  const names = Object.keys(draft.changed());
  const notice = form.querySelector("[data-draft]");
  notice.hidden = !draft.keep();
  notice.querySelector("[data-draft-text]").textContent = names.map((name) => nameOf(name).replaceAll("_", " ")).join(", ");
}

form.addEventListener("input", (event) => {
  if (event.target.name === "note") return;
  showDraft();
  preview.ask();
});

// Enter in a field calculates, as on a worksheet; Ctrl+S or Ctrl+Enter saves.
document.addEventListener("keydown", (event) => {
  const saves = (event.ctrlKey || event.metaKey) && ["s", "Enter"].includes(event.key);
  const isField = event.target.form === form && event.target.matches("input, select");
  if (!saves && !(event.key === "Enter" && isField && event.target.name !== "note")) return;
  event.preventDefault();
  if (saves) form.requestSubmit();
  else preview.ask();
});

form.querySelector("[data-discard]").addEventListener("click", () => {
  draft.forget();
  location.reload();
});

document.addEventListener("submit", ({ target }) => {
  if (target !== form) sessionStorage.setItem(OWN, String(Number(revision) + 1));
});

form.addEventListener("submit", async (event) => {
  event.preventDefault();
  const changed = patch();
  const typed = form.querySelector("[name=note]").value.trim(), isSame = Object.keys(changed).length === 0;
  if (isSame && isJudged) return (state.textContent = "nothing has changed");
  const note = typed || (isSame ? "criteria judged" : "");
  const headers = { "If-Match": `"${revision}"`, Prefer: "wait=1", "Idempotency-Key": onlyOnce() };
  preview.cancel(); // otherwise it would store saved changes as a draft
  state.textContent = "saving …";
  try {
    const { status, location: job } = await call("PATCH", api, { ...changed, ...(note && { note }) }, { headers });
    draft.forget();
    if (status === 202) await regenerated(job);
    location.reload();
  } catch (error) {
    if (error.status === 412) conflict();
    else refuseToSave(error);
  }
});

function regenerated(job) {
  isFollowing = true;
  return follow(job);
}

function refuseToSave(error) {
  if (error.faults?.size) refusePreview(error);
  else refuse(error);
  const wrong = form.querySelector('[aria-invalid="true"]');
  wrong?.focus();
  wrong?.scrollIntoView({ block: "center" });
}

// Return a key that makes a repeated request harmless; crypto.randomUUID exists only on encrypted pages.
const onlyOnce = () => [...crypto.getRandomValues(new Uint32Array(4))].map((part) => part.toString(16)).join("-");

// After somebody else has saved, keep the draft, and apply it to the newest revision when the page is reloaded.
function conflict() {
  conflicted = true;
  draft.keep();
  state.textContent = "not saved";
  tell("Somebody else saved this design meanwhile. Your changes are kept. ");
  const again = Object.assign(document.createElement("button"), { type: "button", textContent: "Show the newest, with my changes" });
  again.addEventListener("click", () => location.reload());
  trouble.append(again);
}

// Set up a step that was loaded into the page: its fields as typed, with their present results.
function adopt(fold) {
  const step = fold.dataset.fold, answer = steps[step];
  startLists(fold);
  for (const watch of watches) watch(fold.querySelectorAll("input, select"));
  draft.fill();
  if (draft.isChanged()) showDraft();
  if (!answer || answer.state === "pending") return;
  showResults(step, answer);
  showValues(form, step, answer, rounded);
  drawPictures(fold, step, answer);
}

async function fetchNames() {
  try {
    names.fill((await call("GET", `${api}/network`)).payload.names);
  } catch (error) {
    tell(`Names for relations are missing: ${error.message}`);
  }
}

async function start() {
  startVerdict(form);
  startDecide(api, patch);
  startTolerances(api, patch);
  startLater(form, adopt);
  if (!namesHere) await fetchNames();
  watches.push(startPicker(form, names), startCompletion(form, namesOf(names, lines)));
  startDrives();
  const from = draft.restore();
  if (from !== null) showDraft();
  const isOwn = sessionStorage.getItem(OWN) === revision; // this user saved it with another form of the page
  if (from !== null && from !== revision && !isOwn) tell(`Revision ${revision} was saved since you typed these changes; look at them once more.`);
  const running = progress.dataset.job;
  if (running) regenerated(`/api/v1/jobs/${running}`).then(() => location.reload());
  const first = showFirst(from);
  startSolids(() => first.then(() => steps));
  if (form.querySelector("[data-elements]")) import("../elements/elements.js").then(({ startElements }) => startElements());
}

// Preview the page when it is opened, after its draft was restored.
async function showFirst(from) {
  try {
    const isPainted = designState === "current" && document.querySelector("[data-painted]"); // with results of a step
    const { payload } = await previewed(undefined, isFollowing || (from === null && !isPainted));
    clear();
    show(payload);
    state.textContent = [state.textContent, waiting(payload)].filter(Boolean).join("; ");
  } catch (error) {
    refusePreview(error);
  }
}

start();
