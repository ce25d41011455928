// The diagram of dependencies: a click on a block opens its step.
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
