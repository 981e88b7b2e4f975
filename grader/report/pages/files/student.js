"use strict";
for (const button of document.querySelectorAll("button.copy")) {
  button.hidden = !navigator.clipboard;
}
addEventListener("click", async ({ target: button }) => {
  if (button.matches("button.copy")) {
    const lines = [...button.parentElement.querySelectorAll("ins")].map((line) =>
      line.textContent.slice(1),
    );
    await navigator.clipboard.writeText(lines.join("\n"));
    button.textContent = "Copied";
  }
});

addEventListener("beforeprint", () =>
  document.querySelectorAll("details").forEach((part) => {
    part.open = true;
  }),
);
