// Call the REST interface. A refusal is thrown with its problem; its `errors` has the faults by name.
export class Refused extends Error {
  constructor(status, problem) {
    super(problem.detail ?? problem.title ?? `answer ${status}`);
    Object.assign(this, { status, problem });
  }

  get faults() {
    return new Map((this.problem.errors ?? []).map(({ name, detail, also }) => [name, withRelated(detail, also)]));
  }
}

// Return a fault with the other inputs that it concerns, as app/web/shared/services.py does.
const withRelated = (detail, also = []) => (also.length ? `${detail}. See also ${also.join(", ")}` : detail);

export async function call(method, path, body, { headers = {}, signal } = {}) {
  const sent = body === undefined ? {} : { body: JSON.stringify(body) };
  const type = body === undefined ? {} : { "Content-Type": "application/json" };
  const answer = await fetch(path, { method, signal, headers: { ...type, ...headers }, ...sent });
  const payload = answer.status === 204 ? null : await answer.json().catch(() => ({}));
  if (!answer.ok) throw new Refused(answer.status, payload ?? {});
  return { payload, status: answer.status, location: answer.headers.get("Location"), tag: answer.headers.get("ETag") };
}

export const units = () =>
  document.querySelector(".switch [aria-current]")?.textContent.trim().toLowerCase() ?? "si";
