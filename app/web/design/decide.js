// The button "Decide": a finer calculation where, and only where, a criterion is undecided or its error unknown.
import { call, units } from "../shared/api.js";
import { calculated } from "../shared/calculation.js";
import { plain } from "../shared/numbers.js";
import { showVerdict } from "../verdict/verdict.js";

const STOPPED = {
  no_finer_level: "no finer level gives an error estimate",
  budget: "the time allowed is used up",
  pending: "a level is still being calculated: press again",
};

export function startDecide(api, patch) {
  const button = document.querySelector("[data-decide]"), place = document.querySelector("[data-decided]");
  if (!button) return;
  button.hidden = button.dataset.wanted === undefined;
  button.addEventListener("click", async () => {
    if (Object.keys(patch()).length) return (place.textContent = "save your changes first");
    button.disabled = true;
    place.textContent = "calculating at finer levels where that decides …";
    try {
      const payload = await decision(api);
      await showVerdict(payload);
      place.textContent = summary(payload);
    } catch (error) {
      place.textContent = error.message;
    } finally {
      button.disabled = false;
    }
  });
}

async function decision(api) {
  const answer = await call("POST", `${api}/decide?units=${units()}`, {}, { headers: { Prefer: "wait=2" } });
  return (answer.status === 202 ? await calculated(answer.location) : answer).payload;
}

function summary({ tried, undecided, error_unknown: unknown = [], stopped, seconds }) {
  const open = undecided.length + unknown.length;
  if (!tried.length && open && stopped === "no_finer_level")
    return `No finer level gives an error estimate for ${open === 1 ? "this one" : `these ${open}`}. Nothing was saved.`;
  const levels = tried.map(({ step, level }) => `${step} at level ${level.replaceAll("_", " ")}`).join(", ");
  const spent = levels ? `Calculated ${levels} in ${plain(Number(seconds.toPrecision(2)))} s` : "Nothing was calculated";
  const left = open ? `; ${open} still open: ${STOPPED[stopped] ?? stopped}` : "; all decided";
  return `${spent}${left}. Nothing was saved.`;
}
