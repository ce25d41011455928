// The script of the form for a new step: lists, names for relations, and faults, as on the page of a design.
import { Refused, call } from "../shared/api.js";
import { startCompletion } from "../shared/completion.js";
import { Names } from "../design/names.js";
import { startPicker } from "../design/picker.js";
import { startLists } from "../lists/lists.js";
import { live } from "../shared/live.js";
import { startSuggestions } from "../shared/suggestions.js";
import { showFaults } from "../shared/results.js";
import { nameOf, patchOf } from "../shared/typed.js";

const form = document.querySelector("[data-new-step]");
const { newStep: step, template, version, design } = form.dataset;
const state = form.querySelector("[data-state]");
const fields = [...form.querySelectorAll("input[id], select[id]")];
const isRelation = (text) => text.trimStart().startsWith("=");

// The values as the interface accepts them.
function typed() {
  const filled = fields.filter(({ value }) => value.trim()).map(({ name, value }) => [name, value]);
  return { inputs: {}, ...patchOf(Object.fromEntries(filled), new Set()).steps?.[step] };
}

// A design checks the step with its relations; without a design, the template checks the values.
const asked = (signal) => (design ? inDesign(signal) : alone(signal));

const inDesign = (signal) =>
  call("POST", `/api/v1/designs/${design}/preview?within=1`, { steps: { [step]: { template, version: Number(version), ...typed() } } }, { signal });

async function alone(signal) {
  const { inputs, ...rest } = typed();
  const values = Object.fromEntries(Object.entries(inputs).filter(([, value]) => typeof value !== "string" || !isRelation(value)));
  const options = { signal, headers: { Prefer: "wait=1" } };
  try {
    return await call("POST", `/api/v1/templates/${template}/versions/${version}/evaluate`, { ...rest, inputs: values }, options);
  } catch (error) {
    if (error instanceof Refused) throw Object.assign(new Error(error.message), { byName: ofStep(error.faults) });
    throw error;
  }
}

const ofStep = (faults) => new Map([...faults].map(([name, detail]) => [`${step}.${name}`, detail]));

const explained = new Set(); // missing values whose fault was shown because their field was folded

// A value that is still missing is counted only; its field is marked when the form is sent. If the fields of all missing
// values are folded, they unfold with the reason: the user sees no other empty field to fill.
function refuse(error) {
  const faults = error.byName ?? error.faults;
  if (!faults?.size) return (state.textContent = error.message);
  const texts = new Map(fields.map(({ name, value }) => [nameOf(name), value.trim()]));
  const missing = [...faults.keys()].filter((name) => texts.get(name) === "");
  if (missing.length && missing.every(isFolded)) missing.forEach((name) => explained.add(name));
  const isShown = (name) => (missing.includes(name) ? explained.has(name) : design || !isRelation(texts.get(name) ?? ""));
  const wrong = new Map([...faults].filter(([name]) => isShown(name)));
  const loose = showFaults(form, wrong);
  tell(missing.length, [...wrong.keys()].filter((name) => !missing.includes(name)).length, [...loose.values()]);
}

const isFolded = (name) => Boolean(fields.find((field) => nameOf(field.name) === name)?.closest("details:not([open])"));

function tell(missing, wrong, loose) {
  const counts = [missing && `${missing} missing`, wrong && `${wrong} wrong`].filter(Boolean).join(", ");
  state.textContent = [counts || "complete", ...loose].join("; ");
  for (const notice of document.querySelectorAll("[data-sent-fault]")) notice.hidden = true; // it concerned the form as sent
}

const checking = live(asked, () => {
  showFaults(form, new Map());
  tell(0, 0, []);
}, refuse);

async function start() {
  startLists();
  startSuggestions(form);
  form.addEventListener("input", checking.ask);
  if (fields.some(({ value, defaultValue }) => value && value !== defaultValue)) checking.ask(); // typed before this script ran
  const own = fields.filter(({ name }) => !name.includes("@")).map(({ name, labels }) => ({ name, role: "input", words: labels[0]?.textContent ?? "", unit: "", value: "" }));
  const others = design ? (await call("GET", `/api/v1/designs/${design}/network`)).payload.names : [];
  const names = new Names([...others, ...own]);
  startPicker(form, names);
  startCompletion(form, names);
}

start();
