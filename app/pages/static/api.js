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

// A file of the service, and the name that it gives it.
export async function fetched(path) {
  const answer = await fetch(path, { credentials: "same-origin" }).catch(() => {
    throw new Error("The service does not answer. Check that it is running, then try again.");
  });
  if (!answer.ok) throw new Error(sentence(await answer.json().catch(() => null), answer));
  const name = /filename="([^"]+)"/.exec(answer.headers.get("Content-Disposition") ?? "")?.[1] ?? "";
  return { file: await answer.blob(), name };
}

// A form with files; `told` hears which share of it has left, because fetch does not say so.
export function upload(path, form, told) {
  return new Promise((done, fail) => {
    const request = new XMLHttpRequest();
    request.open("POST", path);
    request.setRequestHeader("Accept", "application/json");
    request.setRequestHeader("Idempotency-Key", key());
    request.responseType = "json";
    request.upload.addEventListener("progress", (event) => event.lengthComputable && told(event.loaded / event.total));
    request.addEventListener("error", () => fail(new Error("The service does not answer. Check that it is running, then try again.")));
    request.addEventListener("load", () =>
      request.status < 300 ? done(request.response) : fail(new Error(sentence(request.response, request))),
    );
    request.send(form);
  });
}

function sentence(problem, answer) {
  if (!problem) return `The service answered ${answer.status} ${answer.statusText}.`;
  const parts = [problem.where, problem.what ?? problem.detail ?? problem.title].filter(Boolean).join(": ");
  const remedy = problem.remedy && problem.remedy[0].toUpperCase() + problem.remedy.slice(1);
  return remedy ? `${parts}. ${remedy}${/[.?!]$/.test(remedy) ? "" : "."}` : `${parts}.`; // a question has its own sign
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

// Does `work` where a form would be sent: the button waits meanwhile and says so, what goes wrong stands beside the form.
export function submitted(form, work) {
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    const button = form.querySelector("button[type=submit]"), said = button.textContent;
    guarded(button, form.querySelector("[role=alert]"), async () => {
      button.textContent = form.dataset.wait;
      try {
        await work();
      } finally {
        button.textContent = said;
      }
    });
  });
}
