// Raw files described: every change is asked of the service, which says what is missing and what the check doubts.

import { guarded, send } from "./api.js";

const form = document.querySelector("#draft");
const button = form.querySelector("button[type=submit]");
const problem = form.querySelector("[role=alert]");
const layouts = [...form.querySelectorAll("[data-files]")].map((section) => {
  const rows = [...section.querySelectorAll("[data-column]")];
  const roles = rows.map((row) => row.querySelector("[name=role]").value);
  // A column that a file is read to be something, and that is not chosen, is said not to be it.
  return { section, rows, names: JSON.parse(section.dataset.files), taken: new Set(roles.filter((role) => role && role !== "time")) };
});
const WORST = { fault: "failed", doubt: "doubt", note: "" };
const LEVEL = { fault: "error", doubt: "warning", note: "note" };
let asked = 0;

// What the page says of the files of a layout: columns, units and the rate belong to them alone.
function described({ section, rows, names, taken }) {
  const channels = {}, where = layouts.length > 1 ? ` of ${names[0]}` : "";
  for (const role of taken) channels[role] = { column: "-", unit: "" };
  let time = { column: "-", unit: "" };
  for (const row of rows) {
    const role = row.querySelector("[name=role]").value, unit = row.querySelector("[name=unit]").value;
    const before = role === "time" ? time : channels[role], answer = { column: JSON.parse(row.dataset.column), unit };
    if (role && before && before.column !== "-") throw new Error(`Two columns${where} are the ${role}. Choose one.`);
    if (role === "time") time = answer;
    else if (role) channels[role] = answer;
  }
  const field = section.querySelector("[name=rate]");  // as the files state it, unless it was changed
  const rate = time.column === "-" && field.value !== field.defaultValue ? field.value.trim() : "";
  return { channels, time, rate };
}

function answers() {
  const fields = new FormData(form), files = {};
  for (const layout of layouts) for (const name of layout.names) files[name] = described(layout);
  const of = (name) => fields.get(name).trim();
  return { serial: of("serial"), files, output: of("output"), hold: of("hold"), gain: of("gain"), area: of("area"), verify: fields.getAll("verify") };
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
  list(part("findings"), draft.findings.map(({ severity, text }) => ({ severity: WORST[severity], word: LEVEL[severity], text })));
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
