// The script of a template's page: update the results while the user types, and keep the values in the address.
import { drawAccuracy } from "./accuracy.js";
import { Refused, call, units } from "../shared/api.js";
import { calculated } from "../shared/calculation.js";
import { isolated } from "../shared/isolated.js";
import { startLists } from "../lists/lists.js";
import { startSuggestions } from "../shared/suggestions.js";
import { live } from "../shared/live.js";
import { drawPictures, whenSeen } from "../plots/pictures.js";
import { OUTDATED, markOutdated, showFaults, showResults } from "../shared/results.js";
import { optionOf, valueOf } from "../shared/typed.js";
import { drawnVerdict, followLinks } from "../verdict/verdict.js";

const form = document.querySelector("[data-try]"); // its inputs have bare names, and one may be called `dataset`
const path = form.getAttribute("data-try");
const state = form.querySelector("[data-state]");
const headline = document.querySelector("[data-headline]"), criteria = document.querySelector("[data-criteria]");

const LIMIT = "limits."; // prefix of the controls for limits, as in app/web/shared/limits.py

function asked() {
  const typed = [...new FormData(form)].filter(([, text]) => text.trim());
  const asked = { inputs: {} };
  for (const [name, text] of typed) {
    if (name.startsWith(LIMIT)) asked.limits = { ...asked.limits, [name.slice(LIMIT.length)]: valueOf(text) };
    else if (name.startsWith("@")) asked[name.slice(1)] = optionOf(name.slice(1), text.trim());
    else asked.inputs[name] = valueOf(text);
  }
  return asked;
}

const progress = document.querySelector("[data-progress]");

async function tried(signal) {
  const options = { signal, headers: { Prefer: "wait=1" } };
  const answer = await call("POST", `${path}/worksheet?units=${units()}`, asked(), options);
  if (answer.status !== 202) return answer;
  markOutdated(true);
  return calculated(answer.location, signal);
}

function show({ payload }) {
  markOutdated(false);
  progress.hidden = true;
  showFaults(form, new Map());
  showResults("", payload);
  drawPictures(document, "", payload);
  state.textContent = payload.level ? `level ${payload.level}` : "";
  if (criteria) showCriteria(payload);
}

async function showCriteria({ verdict, criteria: judged = [] }) {
  const drawn = judged.length ? await drawnVerdict({ verdict, criteria: judged }).catch(refuse) : undefined;
  if (drawn === null) return;
  headline.textContent = verdict?.headline ?? "";
  criteria.replaceChildren(...(drawn ? [drawn.querySelector(".scroll")] : []));
}

function refuse(error) {
  progress.hidden = true;
  const loose = error instanceof Refused ? showFaults(form, error.faults) : new Map();
  const words = [...loose.values()].join("; ") || (error.faults?.size ? "see the message next to the field" : error.message);
  const hasResults = document.querySelector("[data-output]");
  markOutdated(true);
  state.replaceChildren(isolated(hasResults ? `${words}; ${OUTDATED}` : words));
}

const LONGEST_ADDRESS = 30_000; // [characters]; the service accepts a head of 64 kB, and a reload sends the address twice

function keepInAddress(filled) {
  if (new URLSearchParams(filled).toString().length > LONGEST_ADDRESS) return; // the address keeps the previous values
  history.replaceState(null, "", `?${new URLSearchParams(filled)}`);
  for (const link of document.querySelectorAll(".switch a")) {
    const chosen = new URLSearchParams(link.search).get("units");
    link.search = new URLSearchParams([...filled, ["units", chosen]]);
  }
}

startLists();
startSuggestions();
const preview = live(tried, show, refuse);
form.addEventListener("input", () => {
  keepInAddress([...new FormData(form)].filter(([, text]) => text.trim()));
  preview.ask();
});

if (progress.dataset.job) {
  markOutdated(true);
  calculated(progress.dataset.job).then(show, refuse);
} else if (document.querySelector("[data-output]")) tried().then(show, refuse);
if (criteria) followLinks(criteria, form);
const accuracy = document.querySelector("[data-accuracy]");
if (accuracy) whenSeen(accuracy, () => drawAccuracy(accuracy));
