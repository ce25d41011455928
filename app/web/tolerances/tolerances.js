// The button "Analyse tolerances": a job that can be cancelled, then its result as a part of the page. Nothing is saved.
import { call, units } from "../shared/api.js";
import { calculated } from "../shared/calculation.js";

export function startTolerances(api, patch) {
  const button = document.querySelector("[data-analyse-tolerances]"), form = button?.form;
  if (!form) return;
  const place = document.querySelector("[data-scatter]"), words = document.querySelector("[data-analysed]");
  const analyse = async () => {
    if (Object.keys(patch()).length) return (words.textContent = "save your changes first");
    button.disabled = true;
    words.textContent = "calculating …";
    try {
      place.innerHTML = await result(api, form.action);
      words.textContent = "Nothing was saved.";
    } catch (error) {
      words.textContent = [...(error.faults?.values() ?? [])].join(" ") || error.message;
    } finally {
      button.disabled = false;
    }
  };
  form.addEventListener("submit", (event) => {
    event.preventDefault(); // without this script the form opens a separate page
    analyse();
  });
  const { waits } = form.dataset; // early.js has kept requests made before this script loaded
  delete form.dataset.waits;
  if (waits === "asked") analyse();
}

async function result(api, page) {
  const headers = { Prefer: "respond-async" };
  const { location } = await call("POST", `${api}/tolerance?units=${units()}`, {}, { headers });
  await calculated(location);
  const answer = await fetch(`${page}?part=1&job=${location.split("/").at(-1)}`);
  if (!answer.ok) throw new Error("the result cannot be shown; reload the page");
  return answer.text();
}
