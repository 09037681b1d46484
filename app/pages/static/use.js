// An identified machine put to use: forms that make a controller or queue a hybrid simulation, fields that come and go.

import { send, submitted } from "./api.js";
import { recall, remember } from "./chosen.js";
import "./progress.js";

const key = (form) => `${location.pathname} ${form.dataset.make}`;

for (const form of document.querySelectorAll("form[data-make]")) recall(form, key(form));

// Fields that belong to one choice are there, and sent, only while that is chosen.
for (const form of document.querySelectorAll("form")) {
  for (const choice of form.querySelectorAll("select[data-shows]")) {
    const follow = () => {
      for (const field of form.querySelectorAll(`[data-for="${choice.dataset.shows}"]`)) {
        field.hidden = !field.dataset.of.split(" ").includes(choice.value);
        for (const input of field.querySelectorAll("input, textarea")) {
          input.disabled = input.closest("[data-for][hidden]") !== null;
        }
      }
    };
    choice.addEventListener("change", follow);
    follow(); // a browser may have kept what was chosen before
  }
}

// What is empty is not part of the address; the button says that something is under way.
for (const form of document.querySelectorAll("form[data-sparse]")) {
  form.addEventListener("formdata", ({ formData }) => {
    for (const [name, value] of [...formData]) if (value.trim() === "") formData.delete(name);
  });
  form.addEventListener("submit", () => {
    const button = form.querySelector("button[type=submit]");
    const said = button.textContent;
    button.textContent = form.dataset.wait;
    addEventListener("pageshow", () => (button.textContent = said), { once: true }); // back again
  });
}

const made = { controller: controller, simulation: simulation };

for (const form of document.querySelectorAll("form[data-make]")) {
  submitted(form, async () => {
    const { data } = await send("POST", form.action, await made[form.dataset.make](form));
    remember(form, key(form));
    if (form.dataset.make === "controller") choose(data.id);
    show(form.dataset.make, data.id, form.closest("section").id);
  });
}

// The next simulation is under the controller that was made last.
function choose(id) {
  const form = document.querySelector("form[data-make=simulation]");
  form.elements.controller.add(new Option("", id, true, true));
  remember(form, key(form));
}

// The same page with what was made; what else it shows stays.
function show(what, id, place) {
  const wanted = new URLSearchParams(location.search);
  wanted.set(what, id);
  location.assign(`${location.pathname}?${wanted}#${place}`);
}

async function controller(form) {
  const fields = new FormData(form);
  const asked = { fit: fields.get("fit"), structure: fields.get("structure"), seed: Number(fields.get("seed")) };
  asked.case = await caseOf(fields);
  if (fields.get("part")?.trim()) asked.part = fields.get("part").trim();
  if (fields.get("target") === "own") {
    const target = await read(fields.get("own-target"), "target");
    for (const name of ["numerator", "denominator"]) target[name] = target[name]?.map?.(Number) ?? target[name];
    asked.target = target;
  }
  return withBefore(withSpread(withCondition(asked, fields), fields), fields);
}

async function simulation(form) {
  const fields = new FormData(form);
  const asked = { fit: fields.get("fit"), controller: fields.get("controller"), case: await caseOf(fields) };
  if (fields.get("ground")) asked.ground = await ground(fields);
  asked.map = fields.has("map");
  const isolator = ["stiffness", "damping", "mass"].map((name) => [name, fields.get(`isolator.${name}`).trim()]).filter(([, value]) => value);
  if (isolator.length) asked.isolator = Object.fromEntries(isolator);
  if (fields.get("isolator.part").trim()) asked.isolator_part = fields.get("isolator.part").trim();
  const effects = fields.getAll("effects");
  asked.effects = effects.filter((name) => !fields.get(`strength.${name}`)?.trim());
  const stated = effects.filter((name) => !asked.effects.includes(name));
  asked.set = Object.fromEntries(stated.map((name) => [name, fields.get(`strength.${name}`).trim()]));
  return withBefore(withSpread(withCondition(asked, fields), fields), fields);
}

// The condition of the machine, where it is stated.
function withCondition(asked, fields) {
  const stated = ["value", "serial", "batch"].map((name) => [name, fields.get(`at.${name}`).trim()]).filter(([, value]) => value);
  return stated.length ? { ...asked, at: { over: fields.get("at.over"), ...Object.fromEntries(stated) } } : asked;
}

// What the parameters may be off, where it is stated.
function withSpread(asked, fields) {
  const stated = ["share", "serial", "batch"].map((name) => [name, fields.get(`spread.${name}`).trim()]).filter(([, value]) => value);
  return stated.length ? { ...asked, spread: Object.fromEntries(stated) } : asked;
}

// What is said of the loop when it was stable.
async function withBefore(asked, fields) {
  const of = (name) => fields.get(`before.${name}`).trim();
  const before = {};
  if (of("gain")) before.gain = Number(of("gain"));
  if (of("fit")) before.fit = of("fit");
  if (of("case")) before.case = await read(of("case"), "before case");
  return Object.keys(before).length ? { ...asked, before } : asked;
}

async function caseOf(fields) {
  return fields.get("case") === "own" ? read(fields.get("own-case"), "case") : fields.get("case");
}

// A description in YAML as the service reads it.
async function read(text, where) {
  return (await send("POST", "/use/reading", { text, where })).data;
}

async function ground(fields) {
  const of = (name) => fields.get(`ground.${name}`)?.trim() || undefined;
  const kind = fields.get("ground");
  const asked = { kind, unit: of("unit"), step: of("step"), frequency: of("frequency"), amplitude: of("amplitude"), duration: of("duration") };
  if (kind === "blwn") Object.assign(asked, { band: [of("from"), of("to")], seed: Number(of("seed") ?? 0) });
  if (kind === "record") {
    const file = fields.get("ground.file");
    if (!file?.size) throw new Error("No record is chosen. Choose a text file of accelerations.");
    Object.assign(asked, { text: await file.text(), name: file.name, scale: Number(of("scale") ?? 1) });
  }
  return asked;
}
