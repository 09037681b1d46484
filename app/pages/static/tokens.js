// Tokens: a new one is shown once, to be copied; one that is revoked is refused from then on.

import { guarded, send } from "./api.js";
import { showOnce } from "./once.js";

const form = document.querySelector("form[data-new-token]");

form.addEventListener("submit", (event) => {
  event.preventDefault();
  guarded(form.querySelector("button"), form.querySelector("[role=alert]"), async () => {
    const { name, role, expires } = Object.fromEntries(new FormData(form));
    const { data } = await send("POST", "/api/v1/tokens", { name: name.trim(), role, expires: expires || null });
    showOnce(form.querySelector(".made"), `The token of ${data.name}.`, data.token, "/tokens");
  });
});
