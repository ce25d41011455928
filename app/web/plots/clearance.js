// Move the journal in its clearance circle to its eccentricity and attitude angle. The server draws it first.
import { plain, quantityText } from "../shared/numbers.js";

const TRAVEL = 22; // displacement in the drawing at full eccentricity

export function showClearance(place, picture, values) {
  const eccentricity = values[picture.eccentricity].value, film = values[picture.film];
  const turn = picture.attitude ? values[picture.attitude].value : 0;
  if (typeof eccentricity !== "number") return;
  place.querySelector("[data-attitude]").setAttribute("transform", `rotate(${-turn})`);
  place.querySelector("[data-journal]").setAttribute("transform", `translate(0 ${TRAVEL * Math.min(eccentricity, 1)})`);
  place.querySelector("[data-film]").textContent = quantityText(film);
  place.querySelector("[data-eps]").textContent = `ε = ${plain(eccentricity)}`;
  const words = `Journal displaced by ${plain(eccentricity)} of its clearance; smallest film ${quantityText(film)}`;
  place.querySelector("svg").setAttribute("aria-label", words);
}
