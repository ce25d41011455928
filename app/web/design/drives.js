// The drawing of what drives what: a block leads to its step, which opens.
import { goTo } from "../verdict/verdict.js";

export function startDrives() {
  document.querySelector("[data-drives]")?.addEventListener("click", (event) => {
    const hash = event.target.closest("a")?.getAttribute("href");
    const leadsTo = hash && document.getElementById(hash.slice(1));
    if (!leadsTo) return;
    event.preventDefault();
    goTo(leadsTo);
  });
}
