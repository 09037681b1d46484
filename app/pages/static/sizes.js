// Beside eq. (17) what is left in the unit of the output, computed by the service from the samples.

import { send } from "./api.js";

const panel = document.querySelector("[data-sizes]");

try {
  const { data } = await send("GET", panel.dataset.sizes);
  const named = (of, entries) => Object.entries(entries).map(([name, found]) => [`${of}:${name}`, found]);
  for (const [name, found] of [...named("use", data.uses), ...named("run", data.runs)]) {
    for (const cell of document.querySelectorAll(`[data-size="${CSS.escape(name)}"]`)) {
      cell.textContent = found[`${cell.dataset.of}_in_print`];
      cell.dataset.value = found[cell.dataset.of];
    }
  }
  const said = { fit: "estimation data", verify: "validation data" };
  const white = document.querySelector("[data-white]");
  const parts = Object.entries(data.whiteness).map(([use, { passed, white: some, runs }]) => `${passed ? "pass" : "fail"} on ${said[use]} (${some} of ${runs} runs)`);
  if (parts.length) white.textContent = parts.join(", ");
} catch {
  // a model that is unstable at its values leaves nothing to measure; eq. (17) stands by itself
}
