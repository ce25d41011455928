// The content of this page as the server has it now, in the place of what is shown: what has ended needs no reload.
// Where that fails, `words` says so.
export async function renewed(words) {
  try {
    const answer = await fetch(location.href, { headers: { Accept: "text/html" } });
    if (!answer.ok) throw new Error(`answer ${answer.status}`);
    const page = new DOMParser().parseFromString(await answer.text(), "text/html");
    document.querySelector("main").replaceWith(document.adoptNode(page.querySelector("main")));
  } catch (error) {
    words.textContent = `It has ended, but the page could not be fetched: ${error.message}. Reload the page.`;
  }
}
