// Labels, units and signs of a run, mended in place: what was changed becomes a revision of the matrix.

import { guarded, send } from "./api.js";

const dialog = document.querySelector("#mend");
const form = dialog.querySelector("form");
const problem = form.querySelector("[role=alert]");
const channels = form.querySelector("tbody");
const LABELS = ["use", "gain", "amplitude", "specimen.mass", "specimen.stiffness", "specimen.damping", "rows", "split.validation", "split.gap", "trend"];
const RANGES = ["rows", "split.validation"]; // two sample numbers
const ABSENT = { use: "fit", trend: "none" }; // what a label is that the description does not state
let description, run;

const inside = (data, path) => path.split(".").reduce((found, name) => found?.[name], data);
const text = (value) => (value === undefined || value === null ? "" : [value].flat().join(", "));
const label = (entry, path) => text(inside(entry, path)) || (ABSENT[path] ?? "");

const isTrue = (word) => ["true", "yes"].includes(text(word).toLowerCase()); // a description holds words, but for whole numbers
const inverted = (channel) => isTrue(channel.invert);
const zeroed = (channel) => text(channel.zeroed) && String(isTrue(channel.zeroed)); // "" where nobody said

// The record of a run: itself, or the one that it is an output or the validation data of.
const record = (name) => description.runs.find(({ id }) => String(id) === name) ?? description.runs.find(({ id }) => name.startsWith(`${id}.`));

function fill(entry) {
  run = entry;
  form.querySelector("[data-id]").textContent = entry.id;
  problem.textContent = "";
  form.elements.all.checked = false;
  for (const path of LABELS) form.elements[path].value = label(entry, path);
  channels.replaceChildren(...Object.entries(entry.channels).map(([name, channel]) => row(name, channel)));
}

function row(name, channel) {
  const made = form.querySelector("template").content.cloneNode(true).firstElementChild;
  const [unit, invert] = made.querySelectorAll("input"), zero = made.querySelector("select");
  made.dataset.channel = name;
  made.querySelector("th").textContent = name.replaceAll("_", " ");
  unit.setAttribute("aria-label", `Unit of ${name}`);
  unit.value = text(channel.unit);
  invert.checked = inverted(channel);
  zero.setAttribute("aria-label", `Zero of ${name}`);
  zero.value = zeroed(channel);
  return made;
}

// A merge patch of what differs from the description; an emptied field is taken away.
function changes() {
  const found = {};
  for (const path of LABELS) {
    const now = form.elements[path].value.trim(), before = label(run, path);
    if (now !== before) put(found, path, RANGES.includes(path) && now ? now.split(/[\s,;]+/).map(Number) : now || null);
  }
  if (found.split && found.split.validation === null) found.split = null; // without validation data there is no gap
  for (const each of channels.rows) {
    const [unit, invert] = each.querySelectorAll("input"), zero = each.querySelector("select").value;
    const name = each.dataset.channel, before = run.channels[name];
    if (unit.value.trim() !== text(before.unit)) put(found, `channels.${name}.unit`, unit.value.trim() || null);
    if (invert.checked !== inverted(before)) put(found, `channels.${name}.invert`, invert.checked);
    if (zero !== zeroed(before)) put(found, `channels.${name}.zeroed`, zero ? zero === "true" : null);
  }
  return found;
}

function put(target, path, value) {
  const names = path.split("."), last = names.pop();
  for (const name of names) target = target[name] ??= {};
  target[last] = value;
}

// The same change for another run, but for channels that it does not have.
function fitting(change, entry) {
  const own = Object.entries(change.channels ?? {}).filter(([name]) => name in entry.channels);
  return change.channels ? { ...change, channels: Object.fromEntries(own) } : change;
}

for (const button of document.querySelectorAll("button[data-run]")) {
  button.addEventListener("click", async () => {
    form.reset();
    dialog.showModal();
    await guarded(button, problem, async () => {
      description ??= (await send("GET", `${dialog.dataset.matrix}/description`)).data;
      fill(record(button.dataset.run));
    });
  });
}
form.querySelector("[data-close]").addEventListener("click", () => dialog.close());
form.addEventListener("submit", (event) => {
  event.preventDefault();
  guarded(form.querySelector("button.main"), problem, async () => {
    const change = changes();
    if (Object.keys(change).length === 0) throw new Error("Nothing was changed. Edit a field, or cancel.");
    const chosen = form.elements.all.checked ? description.runs : [run];
    const runs = Object.fromEntries(chosen.map((entry) => [entry.id, fitting(change, entry)]));
    const { data } = await send("POST", `${dialog.dataset.matrix}/revisions`, { runs });
    location.assign(`/matrices/${data.id}`);
  });
});
