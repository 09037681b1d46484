// What is shown once, to be copied; and buttons that ask twice before they revoke.

import { guarded, send } from "./api.js";

export function showOnce(place, words, secret, on) {
  for (const none of document.querySelectorAll("[data-none]")) none.remove();
  const said = document.createElement("p");
  said.textContent = `${words} Copy it now: it is not shown again.`;
  const text = document.createElement("code");
  text.textContent = secret;
  const copy = document.createElement("button");
  copy.type = "button";
  copy.textContent = "Copy";
  copy.addEventListener("click", async () => {
    await navigator.clipboard.writeText(secret);
    copy.textContent = "Copied";
  });
  const done = document.createElement("a");
  done.href = on;
  done.textContent = "Done";
  place.replaceChildren(said, text, " ", copy, " ", done);
}

for (const button of document.querySelectorAll("button[data-revoke]")) {
  button.addEventListener("click", () => {
    if (button.dataset.sure === undefined) {
      button.dataset.sure = "";
      button.textContent = "Revoke for good";
      return;
    }
    guarded(button, document.querySelector("#revoke-problem"), async () => {
      await send("DELETE", button.dataset.revoke);
      location.reload();
    });
  });
}
