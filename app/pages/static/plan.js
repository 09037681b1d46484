// A test plan: the form's limits and program to the service, then the same page with the job and with what it made.

import { send, submitted } from "./api.js";
import { recall, remember } from "./chosen.js";

const key = (plan) => `plan ${plan}`;

for (const form of document.querySelectorAll("form[data-plan]")) {
  recall(form, key(new URLSearchParams(location.search).get("plan")));
  submitted(form, () => make(form));
}

async function make(form) {
  const fields = new FormData(form);
  const given = (name) => fields.get(name)?.trim() || undefined;
  const asked = { fit: given("fit"), program: await program(fields), seconds: given("seconds") };
  asked.seed = Number(given("seed") ?? 0);
  asked.least = Number(given("least") ?? 0.1);
  const rig = [...fields].filter(([name, value]) => name.startsWith("rig.") && value.trim());
  if (rig.length) asked.rig = Object.fromEntries(rig.map(([name, value]) => [name.slice(4), value.trim()]));
  const { data } = await send("POST", "/api/v1/plans", asked);
  remember(form, key(data.id));
  const wanted = new URLSearchParams({ plan: data.id });
  if (asked.fit) wanted.set("fit", asked.fit);
  location.assign(`/plan?${wanted}#made`);
}

// Own lists are YAML, which the service reads.
async function program(fields) {
  if (fields.get("program") !== "own") return fields.get("program");
  return (await send("POST", "/use/reading", { text: fields.get("own"), where: "program" })).data;
}
