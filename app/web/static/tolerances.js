// The button "Analyse tolerances": a job that can be cancelled, then its result as a part of the page. Nothing is saved.
import { call, units } from "./api.js";
import { calculated } from "./calculation.js";

export function startTolerances(api, patch) {
  const button = document.querySelector("[data-analyse-tolerances]");
  if (!button) return;
  const place = document.querySelector("[data-scatter]"), words = document.querySelector("[data-analysed]");
  button.addEventListener("click", async (event) => {
    event.preventDefault(); // without this script it opens a page of its own
    if (Object.keys(patch()).length) return (words.textContent = "save your changes first");
    button.disabled = true;
    words.textContent = "calculating …";
    try {
      place.innerHTML = await result(api, button.form.action);
      words.textContent = "Nothing was saved.";
    } catch (error) {
      words.textContent = [...(error.faults?.values() ?? [])].join(" ") || error.message;
    } finally {
      button.disabled = false;
    }
  });
}

async function result(api, page) {
  const headers = { Prefer: "respond-async" };
  const { location } = await call("POST", `${api}/tolerance?units=${units()}`, {}, { headers });
  await calculated(location);
  const answer = await fetch(`${page}?part=1&job=${location.split("/").at(-1)}`);
  if (!answer.ok) throw new Error("the result cannot be shown; reload the page");
  return answer.text();
}
