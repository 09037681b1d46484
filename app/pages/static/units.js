// The display units that are chosen: a cookie, so that pages, figures and reports come in them.

const YEAR = 365 * 24 * 3600; // s
const form = document.querySelector("#units");

form.addEventListener("submit", (event) => {
  event.preventDefault();
  const chosen = [...new FormData(form).values()].filter(Boolean);
  document.cookie = `units=${encodeURIComponent(chosen.join(","))}; path=/; max-age=${YEAR}; samesite=strict`;
  form.querySelector("[role=status]").textContent = "Saved.";
});
