// The profile likelihood of a model with effects is made by a job: it is followed here, and drawn once it has ended.

import { guarded, send } from "./api.js";

const ENDED = ["succeeded", "failed", "cancelled"];
const place = document.querySelector("#profile");
const button = place?.querySelector("[data-profile]");
const said = place?.querySelector("[data-profile-says]");

button?.addEventListener("click", () => {
  guarded(button, place.querySelector("[role=alert]"), async () => {
    const chosen = place.querySelector("select");
    const { data, location: at } = await send("POST", button.dataset.profile, { parameter: chosen.value });
    const job = await ended(at ?? `/api/v1/jobs/${data.id}`);
    said.textContent = "";
    if (job.state !== "succeeded") throw new Error(job.problem?.detail ?? `The job was ${job.state}.`);
    chosen.form.dispatchEvent(new Event("change"));
  });
});

// The job once it has ended; what it does until then is told.
function ended(address) {
  return new Promise((resolve) => {
    const events = new EventSource(`${address}/events`);
    const read = ({ data }) => {
      const job = JSON.parse(data);
      said.textContent = job.progress.total ? `${job.progress.done} of ${job.progress.total} values` : "waiting";
      if (!ENDED.includes(job.state)) return;
      events.close();
      resolve(job);
    };
    for (const name of ["message", "queued", "running", ...ENDED]) events.addEventListener(name, read);
  });
}

if (place && location.hash === "#profile") place.open = true;
