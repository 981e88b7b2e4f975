"use strict";
{
  const find = (id) => document.getElementById(id);
  let data, form, points, comment, error, newer, large, picture, help, pictures, choices;  // of the page that is shown
  let shown, busy = false, leaving = "", current = 0;
  let typed = [];  // the keys that were pressed while no item was shown: they are for the next one

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
    find("main").inert = true;
    try {
      const mark = { points: points?.value, comment: comment?.value, shown, item: data.item };
      const sent = action === "mark" ? { do: action, ...mark } : { do: action };
      const headers = { "Content-Type": "application/json" };
      const answer = await (await fetch(location.pathname, { method: "POST", headers, body: JSON.stringify(sent) })).json();
      if (answer.go) show(answer.go, await (await fetch(answer.go)).text());
      busy = false;
      find("main").inert = false;
      if (answer.newer) askToKeep(answer);
      else if (answer.error) refuse(answer.error);
    } catch {
      busy = false;
      find("main").inert = false;
      refuse("The review does not respond. Check that its command is still running, then try again.");
    }
    const keys = typed.splice(0);
    for (const key of keys) {
      if (busy) typed.push(key);
      else if (!act(key, document.activeElement)) insertKey(key.key);
    }
  }

  function refuse(why) {
    say(typed.length ? `${why} What was typed after it is discarded.` : why);
    typed = [];
    if (points) { points.focus(); points.select(); }
  }

  /** Show another page without loading it, so that no key is lost. */
  function show(address, text) {
    const page = new DOMParser().parseFromString(text, "text/html");
    document.title = page.title;
    document.querySelector("header.bar")?.remove();
    const header = page.querySelector("header.bar");
    if (header) find("main").before(document.adoptNode(header));
    find("main").replaceWith(document.adoptNode(page.getElementById("main")));
    find("data").textContent = page.getElementById("data").textContent;
    if (!location.pathname.endsWith(`/${address}`)) history.pushState(null, "", address);
    scrollTo(0, 0);
    start();
  }

  /** Insert a key into the field that has the focus, as the browser does. */
  function insertKey(key) {
    const field = document.activeElement;
    if (field !== points && field !== comment) return;
    const [start, end] = [field.selectionStart, field.selectionEnd];
    if (key === "Backspace") field.setRangeText("", start === end ? Math.max(0, start - 1) : start, end, "end");
    else if ([...key].length === 1) field.setRangeText(key, start, end, "end");
  }

  function askToKeep(answer) {
    find("newer-text").textContent = answer.newer;
    newer.dataset.shown = answer.shown;
    newer.hidden = false;
    say(typed.length ? "What was typed after it is discarded." : "");
    typed = [];
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

  const keys = {
    n: () => send("next"), s: () => send("next"), b: () => send("back"), u: () => send("undo"), z: zoom,
    f: () => setPoints(choices.at(-1)), h: () => setPoints(choices.find((button) => button.dataset.name === "half")),
    c: () => comment.focus(), p: () => points.select(), "?": () => help.showModal(),
    k: () => { if (!newer.hidden) keep(); }, r: () => { if (!newer.hidden) replace(); },
  };
  const keysOfEnd = { b: keys.b, u: keys.u };

  function onKey(event) {
    if (event.ctrlKey || event.altKey || event.metaKey || event.isComposing) return;
    const pressed = { key: event.key, code: event.code, shiftKey: event.shiftKey, repeat: event.repeat };
    if (busy ? typed.push(pressed) : act(pressed, event.target)) event.preventDefault();
  }

  /** Do what a key means; return whether it means anything but itself. */
  function act(event, target) {
    const isOther = event.key.length === 1 && event.key > "~" && event.code.startsWith("Key");  // a layout without Latin letters
    const key = isOther ? event.code.slice(3).toLowerCase() : event.key.length === 1 ? event.key.toLowerCase() : event.key;
    if (help?.open) {
      if (key === "?") help.close();
      return key === "?";
    }
    if (large?.open) {
      const steps = { z: zoom, ArrowRight: () => enlarge(current + 1), ArrowLeft: () => enlarge(current - 1) };
      steps[key]?.();
      return key in steps;
    }
    const isField = target === points || target === comment;
    if (key === "Escape" && isField) { target.blur(); return true; }
    if (key === "Enter" && form && !event.shiftKey && (isField || target === document.body)) {
      if (!event.repeat) send("mark");
      return true;
    }
    if (target === comment) return false;
    const action = (form ? keys : keysOfEnd)[key];
    if (action) {
      if (!event.repeat) action();
      return true;
    }
    if (form && !isField && /^[0-9]$/.test(key)) {
      key === "0" ? setPoints(choices[0]) : insert(Number(key));
      return true;
    }
    return target === points && /^[a-z]$/.test(key);
  }

  /** Prepare the page that is shown. */
  function start() {
    data = JSON.parse(find("data").textContent);
    [form, points, comment, error, newer] = ["form", "points", "comment", "error", "newer"].map(find);
    [large, picture, help] = ["large", "large-picture", "help"].map(find);
    pictures = [...document.querySelectorAll("[data-picture]")];
    choices = [...document.querySelectorAll("[data-points]")];
    [shown, leaving, current] = [data.shown, "", 0];
    for (const button of document.querySelectorAll("[data-do]")) button.addEventListener("click", () => send(button.dataset.do));
    const status = find("status");
    if (status?.textContent) {  // screen readers read a live region when it changes
      const text = status.textContent;
      status.textContent = "";
      setTimeout(() => { status.textContent = text; }, 100);
    }
    if (!form) return;
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

  document.addEventListener("keydown", onKey);
  addEventListener("popstate", () => location.reload());
  start();
}
