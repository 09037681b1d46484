// Calls to the service; a problem comes back as one sentence for the reader.

export async function send(method, path, body) {
  const headers = { Accept: "application/json" };
  if (method === "POST") headers["Idempotency-Key"] = key();
  if (body !== undefined && !(body instanceof FormData)) {
    headers["Content-Type"] = "application/json";
    body = JSON.stringify(body);
  }
  let answer;
  try {
    answer = await fetch(path, { method, headers, body, credentials: "same-origin" });
  } catch {
    throw new Error("The service does not answer. Check that it is running, then try again.");
  }
  const data = (answer.headers.get("Content-Type") ?? "").includes("json") ? await answer.json() : null;
  if (!answer.ok) throw Object.assign(new Error(sentence(data, answer)), { problem: data });
  return { data, status: answer.status, location: answer.headers.get("Location") };
}

function sentence(problem, answer) {
  if (!problem) return `The service answered ${answer.status} ${answer.statusText}.`;
  const parts = [problem.where, problem.what ?? problem.detail ?? problem.title].filter(Boolean).join(": ");
  const remedy = problem.remedy && problem.remedy[0].toUpperCase() + problem.remedy.slice(1);
  return remedy ? `${parts}. ${remedy}.` : `${parts}.`;
}

function key() {
  const bytes = crypto.getRandomValues(new Uint8Array(16));
  return [...bytes].map((byte) => byte.toString(16).padStart(2, "0")).join("");
}

// Runs `work` while the button is off; what goes wrong is said in `place`.
export async function guarded(button, place, work) {
  button.disabled = true;
  place.textContent = "";
  try {
    await work();
  } catch (error) {
    place.textContent = error.message;
  } finally {
    button.disabled = false;
  }
}
