// Request previews while the user types: at most one call at a time, the newest wins; it can be cancelled.
const PAUSE = 80; // pause in typing before a request [ms]

export function live(ask, show, refuse, pause = PAUSE) {
  let timer, running;
  const cancel = () => {
    clearTimeout(timer);
    running?.abort();
  };
  const soon = () => {
    clearTimeout(timer);
    timer = setTimeout(async () => {
      running?.abort();
      const mine = (running = new AbortController());
      try {
        const answer = await ask(mine.signal);
        if (!mine.signal.aborted) show(answer);
      } catch (error) {
        if (error.name !== "AbortError" && !mine.signal.aborted) refuse(error);
      }
    }, pause);
  };
  return { ask: soon, cancel };
}
