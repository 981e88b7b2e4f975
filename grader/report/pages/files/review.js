"use strict";
{
  const data = JSON.parse(document.getElementById("data").textContent);
  const find = (id) => document.getElementById(id);
  const [form, points, comment, error, newer] = ["form", "points", "comment", "error", "newer"].map(find);
  const [large, picture, help] = ["large", "large-picture", "help"].map(find);
  const pictures = [...document.querySelectorAll("[data-picture]")];
  let shown = data.shown, busy = false, leaving = "", current = 0;

  const say = (text) => { error.textContent = text; };
  const isChanged = () => form !== null && (points.value !== data.points || comment.value !== data.comment);

  async function send(action) {
    if (busy) return;
    const lost = form && JSON.stringify([action, points.value, comment.value]);  // each text has its own warning
    if (action !== "mark" && isChanged() && leaving !== lost) {
      leaving = lost;
      say(`Not saved. Press the same key again to leave without saving (${action}).`);
      return;
    }
    busy = true;
    say("Saving ...");
    try {
      const sent = action === "mark" ? { do: action, points: points.value, comment: comment.value, shown } : { do: action };
      const headers = { "Content-Type": "application/json" };
      const answer = await (await fetch(location.pathname, { method: "POST", headers, body: JSON.stringify(sent) })).json();
      if (answer.go) {
        location.assign(answer.go);
        return;
      }
      if (answer.newer) askToKeep(answer);
      else refuse(answer.error);
    } catch {
      refuse("The review does not respond. Check that its command is still running, then try again.");
    }
    busy = false;
  }

  function refuse(why) {
    say(why);
    if (points) { points.focus(); points.select(); }
  }

  function askToKeep(answer) {
    find("newer-text").textContent = answer.newer;
    newer.dataset.shown = answer.shown;
    newer.hidden = false;
    say("");
    find("keep").focus();
  }

  function keep() { discard(); send("next"); }
  function replace() { shown = Number(newer.dataset.shown); newer.hidden = true; send("mark"); }
  function discard() { points.value = data.points; comment.value = data.comment; }

  function setPoints(button) {
    if (!button) return;
    points.value = button.dataset.points;
    points.focus();
  }

  function insert(number) {
    const text = data.comments[number - 1];
    if (text === undefined) return;
    if (!comment.value.includes(text)) comment.value += (comment.value && !comment.value.endsWith(" ") ? " " : "") + text;
    comment.focus();
  }

  function enlarge(number) {
    if (!pictures.length) return;
    current = (number + pictures.length) % pictures.length;
    const image = pictures[current].querySelector("img");
    picture.src = image.src;
    picture.alt = image.alt;
    find("large-words").textContent = pictures.length > 1 ? `${current + 1} of ${pictures.length}: ${image.alt}` : image.alt;
    large.classList.remove("own-size");
    if (!large.open) large.showModal();
  }

  function zoom() {
    if (!large.open) enlarge(Math.max(0, pictures.indexOf(document.activeElement)));
    else if (large.classList.contains("own-size")) large.close();
    else large.classList.add("own-size");
  }

  const choices = [...document.querySelectorAll("[data-points]")];
  const keys = {
    n: () => send("next"), s: () => send("next"), b: () => send("back"), u: () => send("undo"), z: zoom,
    f: () => setPoints(choices.at(-1)), h: () => setPoints(choices.find((button) => button.dataset.name === "half")),
    c: () => comment.focus(), p: () => points.select(), "?": () => help.showModal(),
    k: () => { if (!newer.hidden) keep(); }, r: () => { if (!newer.hidden) replace(); },
  };
  const keysOfEnd = { b: keys.b, u: keys.u };

  function onKey(event) {
    if (event.ctrlKey || event.altKey || event.metaKey || event.isComposing) return;
    const isOther = event.key.length === 1 && event.key > "~" && event.code.startsWith("Key");  // a layout without Latin letters
    const key = isOther ? event.code.slice(3).toLowerCase() : event.key.length === 1 ? event.key.toLowerCase() : event.key;
    if (help?.open) {
      if (key === "?") { event.preventDefault(); help.close(); }
      return;
    }
    if (large?.open) {
      const steps = { z: zoom, ArrowRight: () => enlarge(current + 1), ArrowLeft: () => enlarge(current - 1) };
      if (steps[key]) { event.preventDefault(); steps[key](); }
      return;
    }
    const isField = event.target === points || event.target === comment;
    if (key === "Escape" && isField) { event.target.blur(); return; }
    if (key === "Enter" && form && !event.shiftKey && (isField || event.target === document.body)) {
      event.preventDefault();
      if (!event.repeat) send("mark");
      return;
    }
    if (event.target === comment) return;
    const action = (form ? keys : keysOfEnd)[key];
    if (action) {
      event.preventDefault();
      if (!event.repeat) action();
    } else if (form && !isField && /^[0-9]$/.test(key)) {
      event.preventDefault();
      key === "0" ? setPoints(choices[0]) : insert(Number(key));
    } else if (event.target === points && /^[a-z]$/.test(key)) {
      event.preventDefault();
    }
  }

  document.addEventListener("keydown", onKey);
  for (const button of document.querySelectorAll("[data-do]")) button.addEventListener("click", () => send(button.dataset.do));
  const status = find("status");
  if (status?.textContent) {  // screen readers read a live region when it changes
    const text = status.textContent;
    status.textContent = "";
    setTimeout(() => { status.textContent = text; }, 100);
  }
  if (form) {
    points.value = data.points;
    comment.value = data.comment;
    form.addEventListener("submit", (event) => { event.preventDefault(); send("mark"); });
    for (const button of choices) button.addEventListener("click", () => setPoints(button));
    for (const button of document.querySelectorAll("[data-comment]")) button.addEventListener("click", () => insert(Number(button.dataset.comment)));
    pictures.forEach((button, number) => button.addEventListener("click", () => enlarge(number)));
    large.addEventListener("click", zoom);
    find("keep").addEventListener("click", keep);
    find("replace").addEventListener("click", replace);
    find("help-button").addEventListener("click", () => help.showModal());
    points.focus();
    points.select();
  }
}
