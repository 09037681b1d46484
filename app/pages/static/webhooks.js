// Webhooks: the secret of a new one is shown once, to be copied; one that is revoked is told nothing more.

import { guarded, send } from "./api.js";
import { showOnce } from "./once.js";

const form = document.querySelector("form[data-new-webhook]");

form?.addEventListener("submit", (event) => {
  event.preventDefault();
  guarded(form.querySelector("button"), form.querySelector("[role=alert]"), async () => {
    const asked = new FormData(form);
    const { data } = await send("POST", "/api/v1/webhooks", { url: asked.get("url").trim(), events: asked.getAll("events") });
    showOnce(form.querySelector(".made"), `The secret of the webhook to ${data.url}.`, data.secret, "/webhooks");
  });
});
