// The button "Decide": a finer calculation only for criteria that are undecided or whose error is unknown.
// The page states the cost first; a long calculation starts only after a second click.
import { call, units } from "../shared/api.js";
import { calculated } from "../shared/calculation.js";
import { plain } from "../shared/numbers.js";
import { showVerdict } from "../verdict/verdict.js";

const STOPPED = {
  no_finer_level: "no finer level gives an error estimate",
  budget: "the allowed time is used up",
  pending: "a level is still being calculated: press again",
};
const SHORT = 2, ALLOWED = 60, LONGEST = 600; // [s]: started at once; smallest and largest budget
const BUSY = 10; // factor on the estimated processor time, because a server has other work too

export function startDecide(api, patch) {
  const button = document.querySelector("[data-decide]"), place = document.querySelector("[data-decided]");
  const variants = document.querySelector("[data-decided-variants]");
  if (!button) return;
  let allowed = null; // [s], once the cost was stated
  button.hidden = button.dataset.wanted === undefined;
  button.addEventListener("click", async () => {
    if (Object.keys(patch()).length) return (place.textContent = "save your changes first");
    button.disabled = true;
    try {
      if (allowed === null) {
        place.textContent = "estimating the time …";
        const estimate = await asked(api, { estimate_only: true });
        if (!estimate.planned.length) return (place.textContent = summary(estimate));
        allowed = Math.min(LONGEST, Math.max(ALLOWED, Math.ceil(BUSY * estimate.expected)));
        place.textContent = cost(estimate, allowed);
        if (estimate.expected > SHORT) return (button.textContent = `Decide, about ${seconds(estimate.expected)}`);
      }
      const payload = await asked(api, { budget: `${allowed} s` });
      await showVerdict(payload);
      place.textContent = summary(payload);
      variants.replaceChildren(...(payload.variants ?? []).map(headline));
      allowed = null;
      button.textContent = "Decide";
    } catch (error) {
      allowed = null;
      place.textContent = error.message;
    } finally {
      button.disabled = false;
    }
  });
}

async function asked(api, body) {
  const answer = await call("POST", `${api}/decide?units=${units()}`, body, { headers: { Prefer: "wait=2" } });
  return (answer.status === 202 ? await calculated(answer.location) : answer).payload;
}

const seconds = (time) => `${plain(Number(time.toPrecision(2)))} s`;

function headline({ name, verdict }) {
  const item = document.createElement("li"), strong = document.createElement("strong");
  strong.textContent = name;
  item.append(strong, `: ${verdict?.headline ?? "not judged"}`);
  return item;
}

// Return the levels to calculate, each step at each level once, and for how many designs.
function named(trials) {
  const times = new Map();
  for (const { step, level } of trials) {
    const name = `${step} at level ${level.replaceAll("_", " ")}`;
    times.set(name, (times.get(name) ?? 0) + 1);
  }
  return [...times].map(([name, count]) => (count > 1 ? `${name} (${count} times)` : name)).join(", ");
}

function cost({ planned, expected }, allowed) {
  return `First ${named(planned)}: about ${seconds(expected)} of processor time. No level begins after ${allowed} s.`;
}

function summary({ tried, planned = [], undecided, error_unknown: unknown = [], stopped, seconds: spent }) {
  const open = undecided.length + unknown.length;
  if (!tried.length && open && (stopped === "no_finer_level" || (stopped === "estimated" && !planned.length)))
    return `No finer level gives an error estimate for ${open === 1 ? "this one" : `these ${open}`}. Nothing was saved.`;
  const done = tried.length ? `Calculated ${named(tried)} in ${seconds(spent)}` : "Nothing was calculated";
  const left = open ? `; ${open} still open: ${STOPPED[stopped] ?? stopped}` : "; all decided";
  return `${done}${left}. Nothing was saved.`;
}
