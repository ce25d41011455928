// The button "Decide": an exacter calculation where, and only where, a criterion is undecided. Nothing is saved.
import { call, units } from "./api.js";
import { showVerdict } from "./verdict.js";

export function startDecide(api, patch) {
  const button = document.querySelector("[data-decide]"), place = document.querySelector("[data-decided]");
  if (!button) return;
  button.hidden = false;
  button.addEventListener("click", async () => {
    if (Object.keys(patch()).length) return (place.textContent = "save your changes first");
    button.disabled = true;
    place.textContent = "calculating more exactly where it decides …";
    try {
      const { told: answer } = await call("POST", `${api}/decide?units=${units()}`, {}, { headers: { Prefer: "wait=30" } });
      showVerdict(answer);
      place.textContent = spent(answer);
    } catch (error) {
      place.textContent = error.message;
    } finally {
      button.disabled = false;
    }
  });
}

function spent({ seconds, spent: rounds = [] }) {
  const climbed = rounds.map(({ step, level }) => `${step} at level ${level}`.replaceAll("_", " ")).join(", ");
  const time = typeof seconds === "number" ? ` in ${seconds.toPrecision(2)} s` : "";
  return climbed ? `Decided with ${climbed}${time}. Nothing was saved.` : `No level has a smaller error${time}.`;
}
