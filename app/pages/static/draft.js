// Raw files described: every change is asked of the service, which says what is missing and what the check doubts.

import { guarded, send } from "./api.js";

const form = document.querySelector("#draft");
const button = form.querySelector("button[type=submit]");
const problem = form.querySelector("[role=alert]");
const rows = [...form.querySelectorAll("[data-column]")];
const WORST = { fault: "failed", doubt: "doubt", note: "" };
let asked = 0;

// A column that a file is read to be something, and that is not chosen, is said not to be it.
const taken = new Set(rows.map((row) => row.querySelector("[name=role]").value).filter((role) => role && role !== "time"));

function answers() {
  const fields = new FormData(form), channels = {};
  let time = { column: "", unit: "" };
  for (const role of taken) channels[role] = { column: "-", unit: "" };
  for (const row of rows) {
    const role = row.querySelector("[name=role]").value, unit = row.querySelector("[name=unit]").value;
    const answer = { column: row.dataset.column, unit };
    if (role === "time") time = answer;
    else if (role && channels[role] && channels[role].column !== "-") throw new Error(`Two columns are the ${role}. Choose one.`);
    else if (role) channels[role] = answer;
  }
  const of = (name) => fields.get(name).trim();
  const rate = time.column === "" ? of("rate") : "";
  return { serial: of("serial"), channels, time, rate, output: of("output"), hold: of("hold"), gain: of("gain"), area: of("area"), verify: fields.getAll("verify") };
}

function list(place, items) {
  const one = document.querySelector("#said");
  place.replaceChildren(...items.map(({ severity, word, text }) => {
    const item = one.content.firstElementChild.cloneNode(true), [mark, said] = item.children;
    if (word) mark.textContent = word;
    else mark.remove();
    if (severity) mark.classList.add(severity);
    said.textContent = text;
    return item;
  }));
}

function show(draft) {
  const part = (name) => form.querySelector(`[data-${name}]`);
  list(part("missing"), draft.missing.map(({ question }) => ({ severity: "doubt", word: "missing", text: question })));
  list(part("findings"), draft.findings.map(({ severity, text }) => ({ severity: WORST[severity], word: severity, text })));
  list(part("doubts"), draft.doubts.map((text) => ({ text })));
  part("description").hidden = !draft.description;
  part("description").querySelector("pre").textContent = draft.description;
  button.disabled = draft.missing.length > 0;
}

async function ask() {
  const turn = ++asked;
  problem.textContent = "";
  try {
    const { data } = await send("POST", form.action, answers());
    if (turn === asked) show(data);
  } catch (error) {
    if (turn !== asked) return;
    problem.textContent = error.message;
    button.disabled = true;
  }
}

form.addEventListener("change", ask);
form.addEventListener("submit", (event) => {
  event.preventDefault();
  guarded(button, problem, async () => {
    const { data } = await send("POST", `${form.action}/matrix`, answers());
    location.assign(`/matrices/${data.id}`);
  });
});
ask();
