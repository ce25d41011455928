// The panel "Finite elements": request an analysis, follow its job, show its results, paint the solid.
import { showAnalysis } from "./analyses.js";
import { Refused, call, units } from "../shared/api.js";
import { isolated } from "../shared/isolated.js";
import { quantityText as written } from "../shared/numbers.js";
import { follow } from "../shared/progress.js";

const EXTRA = "maximum_stress"; // calculated only if its box is ticked

export function startElements(root = document) {
  for (const place of root.querySelectorAll("[data-elements]")) start(place);
}

function start(place) {
  const asks = place.querySelector("[data-asks]"), kind = ask(place, "kind");
  const button = place.querySelector("[data-analyse]");
  asks.hidden = false;
  // On a design's page the panel is inside the worksheet's form, but its fields do not belong to that form.
  for (const event of ["input", "change"]) place.addEventListener(event, (happened) => happened.stopPropagation());
  kind.addEventListener("change", () => asDeclared(place));
  asDeclared(place);
  button.addEventListener("click", async () => {
    button.disabled = true;
    tell(place, "");
    try {
      await show(place, await analysed(place));
    } catch (error) {
      tell(place, error.message);
    } finally {
      button.disabled = false;
    }
  });
}

const ask = (place, name) => place.querySelector(`[data-ask="${name}"]`);

// Preselect the options with which the design itself makes this analysis, so that nothing is calculated twice.
function asDeclared(place) {
  const { boundary, level, load } = ask(place, "kind").selectedOptions[0].dataset;
  if (boundary) ask(place, "boundary").value = boundary;
  if (level) ask(place, "level").value = level;
  if (load) ask(place, "load").value = load;
  const { isTable, hasStress } = optionsOf(place);
  for (const [name, applies] of Object.entries({ boundary: !isTable, load: hasStress, [EXTRA]: hasStress })) ask(place, name).closest("label").hidden = !applies;
  for (const within of ask(place, "level").options) within.hidden = isTable && Boolean(Number(within.value));
}

// Show the options of the chosen kind: tables have unit loads and fixed supports; only stress has a load.
function optionsOf(place) {
  const { outputs, tables } = ask(place, "kind").selectedOptions[0].dataset, names = outputs.split(" ");
  return { names, isTable: tables !== undefined, hasStress: names.includes(EXTRA) };
}

function tell(place, words) {
  const notice = place.querySelector("[data-refused]");
  notice.replaceChildren(...(words ? [isolated(words)] : []));
  notice.hidden = !words;
}

// Send the request and wait for its job, if any; return the answer in the units of the page, and its load in N·m.
async function analysed(place) {
  const { payload: built } = await call("GET", `/api/v1/builds/${place.dataset.build}`);
  const path = `${place.dataset.elements}/${ask(place, "kind").value}`, body = asked(place, built.parameters);
  const { payload: analysis, status, location } = await call("POST", path, body, { headers: { Prefer: "respond-async" } });
  if (status === 202) await finished(place, location);
  const { payload: answer } = await call("GET", `/api/v1/analyses/${analysis.id}?units=${units()}&load=${encodeURIComponent(body.load ?? "1 N*m")}`);
  return { ...answer, newtonMetres: analysis.load.value };
}

function asked(place, parameters) {
  const level = ask(place, "level").value, { names, isTable, hasStress } = optionsOf(place);
  const load = ask(place, "load").value.replaceAll("·", "*"), boundary = ask(place, "boundary").value;
  return {
    parameters: Object.fromEntries(Object.entries(parameters).map(([name, { value, unit }]) => [name, unit ? { value, unit } : value])),
    ...(isTable ? {} : { boundary }),
    ...(hasStress ? { load } : {}),
    ...(Number(level) ? { tolerance: Number(level) } : { level }),
    outputs: names.filter((name) => name !== EXTRA || ask(place, EXTRA).checked),
  };
}

async function finished(place, job) {
  const progress = place.querySelector("[data-elements-progress]");
  await follow(job, progress, "The solid is being analysed …");
  progress.hidden = true;
  const { payload: ended } = await call("GET", job);
  if (ended.problem) throw new Refused(ended.problem.status, ended.problem);
  if (ended.state !== "done") throw new Error(`The analysis was ${ended.state}.`);
}

async function show(place, analysis) {
  showAnalysis(place.querySelector("[data-analyses]"), analysis);
  const view = place.querySelector("[data-deformed]"), colour = place.querySelector("[data-colour]");
  if (!analysis.outputs.surface) {
    view.hidden = true;
    return;
  }
  const { payload: stored } = await call("GET", `${analysis.outputs.surface.url}?units=${units()}`);
  const { drawDeformed, fieldsOf, under } = await import("./deformed.js");
  const surface = under(stored, analysis.newtonMetres, written(analysis.load));
  const names = Object.keys(fieldsOf(surface)), before = colour.value;
  colour.replaceChildren(...names.map((name) => new Option(name, name, false, name === before)));
  view.hidden = false;
  const drawing = view.querySelector(".drawing");
  colour.onchange = () => drawDeformed(drawing, surface, colour.value);
  await colour.onchange();
}
