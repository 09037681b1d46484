// Raw files described: every change is asked of the service, which says what is missing and what the check doubts.
// A question is answered in the panel of questions, or where its column stands. Another dialect draws the columns again.

import { guarded, send } from "./api.js";

const form = document.querySelector("#draft");
const button = form.querySelector("button[type=submit]");
const problem = form.querySelector("[role=alert]");
const questions = form.querySelector("[data-missing]");
const WORST = { fault: "failed", doubt: "doubt", note: "" };
const LEVEL = { fault: "error", doubt: "warning", note: "note" };
let layouts = read(form.querySelector("[data-layouts]"));
let asked = 0;

// The layouts of the page as the service drew them: what each column is taken for there is told apart from what is chosen.
function read(place) {
  return [...place.querySelectorAll("[data-files]")].map((section) => {
    const rows = [...section.querySelectorAll("[data-column]")];
    const roles = rows.map((row) => row.querySelector("[name=role]").value);
    // A column that a file is read to be something, and that is not chosen, is said not to be it.
    return { section, rows, names: JSON.parse(section.dataset.files), taken: new Set(roles.filter((role) => role && role !== "time")) };
  });
}

// The dialect that is stated of the files of a layout; nothing where all is automatic.
function dialect({ section }) {
  const stated = {};
  for (const field of section.querySelectorAll("[data-dialect] [name]")) {
    if (field.value !== "") stated[field.name] = field.type === "number" ? Number(field.value) : field.value;
  }
  return stated;
}

// What the page says of the files of a layout: columns, units and the rate belong to them alone.
function described(layout) {
  const { section, rows, names, taken } = layout;
  const channels = {}, where = layouts.length > 1 ? ` of ${names[0]}` : "";
  for (const role of taken) channels[role] = { column: "-", unit: "" };
  if (!rows.length) return { dialect: dialect(layout) };
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
  return { channels, time, rate, dialect: dialect(layout) };
}

function answers() {
  const fields = new FormData(form), files = {};
  for (const layout of layouts) for (const name of layout.names) files[name] = described(layout);
  const of = (name) => fields.get(name).trim();
  return { serial: of("serial"), files, output: of("output"), hold: of("hold"), gain: of("gain"), area: of("area"), verify: fields.getAll("verify"), validation: Number(of("validation")) / 100 };
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

// What a question asks for: a unit, a column, a sample rate. Its answer is put where the column stands.
const FIELDS = {
  unit(role, concerned) {
    const field = document.querySelector("#units").content.firstElementChild.cloneNode(true);
    return [field, (value) => concerned((row) => row.querySelector("[name=role]").value === role, "unit", value)];
  },
  channel(role, concerned, { rows }) {
    const field = document.createElement("select"), free = rows.filter((row) => !row.querySelector("[name=role]").value);
    const named = free.map((row) => new Option(row.querySelector("th").textContent, row.dataset.column));
    field.append(new Option("choose a column", ""), ...named);
    return [field, (value) => concerned((row) => row.dataset.column === value, "role", role)];
  },
  rate(_, __, { section }) {
    const field = section.querySelector("[name=rate]").cloneNode();
    return [field, (value) => { section.querySelector("[name=rate]").value = value; }];
  },
};

function question({ key, question: text, files }) {
  const [kind, role] = key.split(" "), of = layouts.filter(({ names }) => names.some((name) => files.includes(name)));
  const place = document.querySelector("#asked").content.firstElementChild.cloneNode(true);
  const label = place.querySelector("label");
  label.textContent = text.charAt(0).toUpperCase() + text.slice(1);
  place.dataset.question = `${key} ${files.join()}`;
  if (!FIELDS[kind] || !of.length) {
    label.replaceWith(...label.childNodes);
    return place;
  }
  const concerned = (is, name, value) => {
    for (const { rows } of of) for (const row of rows) if (is(row)) row.querySelector(`[name=${name}]`).value = value;
  };
  const [field, put] = FIELDS[kind](role, concerned, of[0]);
  field.id = `asked-${key.replace(" ", "-")}-${of[0].section.id}`;
  field.removeAttribute("name");  // the form has it where the column stands
  label.htmlFor = field.id;
  field.addEventListener("change", () => put(field.value));
  place.append(field);
  return place;
}

// A question that is still open stays as it is, so that whoever is at its field is not interrupted.
function ask_of(missing) {
  const open = new Map([...questions.children].map((place) => [place.dataset.question, place]));
  const wanted = missing.filter(({ key }) => key !== "serial").map((one) => open.get(`${one.key} ${one.files.join()}`) ?? question(one));
  const left = questions.contains(document.activeElement) && !wanted.some((place) => place.contains(document.activeElement));
  for (const place of [...questions.children]) if (!wanted.includes(place)) place.remove();
  for (const [number, place] of wanted.entries()) if (questions.children[number] !== place) questions.insertBefore(place, questions.children[number] ?? null);
  if (left) (questions.querySelector("select, input") ?? button).focus();
}

function show(draft) {
  const part = (name) => form.querySelector(`[data-${name}]`);
  ask_of(draft.missing);
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

// The columns as the service reads them in the dialects that are stated now; what was said of other files stays said.
async function redraw(changed) {
  const turn = ++asked, address = new URL(location.href), dialects = {};
  for (const layout of layouts) for (const name of layout.names) if (Object.keys(dialect(layout)).length) dialects[name] = dialect(layout);
  if (Object.keys(dialects).length) address.searchParams.set("dialects", JSON.stringify(dialects));
  else address.searchParams.delete("dialects");
  problem.textContent = "";
  const answer = await fetch(address, { credentials: "same-origin" });
  if (turn !== asked) return;
  const page = new DOMParser().parseFromString(await answer.text(), "text/html"), drawn = page.querySelector("[data-layouts]");
  if (!drawn) {
    problem.textContent = page.querySelector("main p")?.textContent ?? "The service could not read the files with these settings.";
    button.disabled = true;
    return;
  }
  history.replaceState(null, "", address);
  const focused = document.activeElement.id, before = layouts.filter((one) => one !== changed);
  layouts = read(drawn);
  for (const layout of layouts) keep(before.find(({ names }) => names.join() === layout.names.join()), layout);
  form.querySelector("[data-layouts]").replaceWith(drawn);
  document.getElementById(focused)?.focus();
  ask();
}

function keep(old, { section, rows }) {
  if (!old) return;
  for (const row of rows) {
    const same = old.rows.find((one) => one.dataset.column === row.dataset.column);
    for (const name of ["role", "unit"]) if (same) row.querySelector(`[name=${name}]`).value = same.querySelector(`[name=${name}]`).value;
  }
  const rate = old.section.querySelector("[name=rate]");
  if (rate) section.querySelector("[name=rate]").value = rate.value;
}

form.addEventListener("change", (event) => {
  const stated = event.target.closest("[data-dialect]");
  if (stated) guarded(button, problem, () => redraw(layouts.find(({ section }) => section.contains(stated))));
  else ask();
});
form.addEventListener("submit", (event) => {
  event.preventDefault();
  guarded(button, problem, async () => {
    const { data } = await send("POST", `${form.action}/matrix`, answers());
    location.assign(`/matrices/${data.id}`);
  });
});
ask();
