"use strict";
/* Highlight the link of the failure that has the focus or the pointer; a click on its number turns the robot to the link. */
for (const badge of viewer ? document.querySelectorAll("[data-show]") : []) {
  const number = Number(badge.dataset.show), { link } = pageData.callouts.find((callout) => callout.number === number);
  const card = badge.closest("article");
  card.addEventListener("focusin", (event) => { if (event.target.closest("article") === card) viewer.choose(link); });
  const mark = (on) => {
    viewer.state.hover = on ? link : -1;
    viewer.schedule();
    for (const title of document.querySelectorAll(".views title")) title.parentElement.classList.toggle("lit", on && title.textContent === pageData.robot.links[link]);
  };
  card.addEventListener("pointerenter", () => mark(true));
  card.addEventListener("pointerleave", () => mark(false));
  badge.addEventListener("click", (event) => {
    event.preventDefault();
    viewer.show(number);
    viewer.canvas.scrollIntoView({ block: "nearest" });
    viewer.canvas.focus({ preventScroll: true });
  });
}
