"use strict";
{
  const find = (id) => document.getElementById(id);
  let data, form, points, comment, error, newer, large, picture, help, pictures, buttons, each;  // of the page that is shown
  let shown, busy = false, leaving = "", current = 0;
  let typed = [];  // the keys that were pressed while no item was shown: they are for the next one

  const say = (text, isBusy = false) => { error.textContent = text; error.classList.toggle("busy", isBusy); };
  const written = () => [points.value, comment.value, ...each.map((field) => field.value)];
  const fill = (values) => [points, comment, ...each].forEach((field, at) => { field.value = values[at] ?? ""; });
  const isChanged = () => form !== null && String(written()) !== String([data.points, data.comment, ...data.each]);
  const sentPoints = () => each.length ? each.map((field) => field.value.replace(/\s/g, "")).join(" ") : points?.value;

  const chosenSimilar = () => Object.fromEntries([...document.querySelectorAll("[data-similar]:checked")].map((box) => [box.dataset.similar, data.similar[box.dataset.similar]]));

  async function send(action, more = {}) {
    if (busy) return;
    if (action === "mark" && !points.value.trim()) { refuse("Enter the points first."); return; }
    const lost = form && JSON.stringify([action, more, written()]);  // each text has its own warning
    if (action !== "mark" && isChanged() && leaving !== lost) {
      leaving = lost;
      say("Not saved. Do the same again to leave without saving.");
      for (const list of document.querySelectorAll("[data-filter]")) list.value = list.querySelector("[selected]").value;
      return;
    }
    busy = true;
    say("Saving ...", true);
    find("main").inert = true;
    try {
      const mark = action === "mark" ? { points: sentPoints(), comment: comment.value, shown, similar: chosenSimilar() } : {};
      const sent = { do: action, ...mark, ...more };
      const headers = { "Content-Type": "application/json" };
      const answer = await (await fetch(location.pathname, { method: "POST", headers, body: JSON.stringify(sent) })).json();
      const kept = answer.error && form ? written() : null;
      if (answer.go) show(answer.go, await (await fetch(answer.go)).text());
      if (kept && form) fill(kept);
      busy = false;
      find("main").inert = false;
      if (answer.newer) askToKeep(answer);
      else if (answer.error) refuse(answer.error);
    } catch (problem) {
      busy = false;
      find("main").inert = false;
      const hasEnded = problem instanceof TypeError;  // of fetch: there is no connection
      const why = hasEnded ? "The server has ended: run `grader review` again, and open its new address." : "The review has failed on this. Try again.";
      refuse(action === "mark" ? `${why} This mark is not saved.` : why);
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
    RobotView?.close();
    RobotView = showRobot();
    scrollTo(0, 0);
    start();
    loadPeople();
  }

  // The list of students stays while items change.
  let people = [];
  const plain = (text) => text.toLowerCase().normalize("NFD").replace(/\p{M}/gu, "");

  async function loadPeople() {
    const here = location.pathname;
    try {
      const found = (await (await fetch(`${here}/people`)).json()).people;
      if (here !== location.pathname) return;
      people = found;
      listPeople();
    } catch { /* the next action says so */ }
  }

  function listPeople() {
    const words = plain(find("find").value).split(/\s+/);
    const found = people.filter(([name]) => words.every((word) => plain(name).includes(word)));
    const left = people.filter(([, count]) => count).length;
    find("found-people").textContent = found.length < people.length ? `${found.length} of ${people.length}` : `${people.length} students, ${left} with items left`;
    find("people-list").replaceChildren(...found.slice(0, 300).map(([name, count, address]) => {
      const row = document.createElement("li"), button = document.createElement("button"), state = document.createElement("span");
      state.textContent = count ? `${count} left` : "✓ done";
      button.append(name, " ", state);
      button.classList.toggle("done", !count);
      button.ariaCurrent = data.people?.includes(name) ? "true" : "false";
      button.addEventListener("click", () => { find("people").hidePopover(); send("go", { to: address }); });
      row.append(button);
      return row;
    }));
    find("people-list").querySelector("[aria-current=true]")?.scrollIntoView({ block: "nearest" });
  }

  function searchPeople() {
    if (!find("find").checkVisibility()) find("people").showPopover();
    find("find").select();
    find("find").focus();
  }

  /** Insert a key into the field that has the focus, as the browser does. */
  function insertKey(key) {
    const field = document.activeElement;
    if (![points, comment].includes(field)) return;
    const [start, end] = [field.selectionStart, field.selectionEnd];
    if (key === "Backspace") field.setRangeText("", start === end ? Math.max(0, start - 1) : start, end, "end");
    else if ([...key].length === 1) field.setRangeText(key, start, end, "end");
    field.dispatchEvent(new Event("input"));
  }

  function askToKeep(answer) {
    find("newer-text").textContent = answer.newer;
    newer.hidden = false;
    say(typed.length ? "What was typed after it is discarded." : "");
    typed = [];
    find("keep").focus();
  }

  function keep() { discard(); send("next"); }
  function replace() { shown = `${data.shown}!`; newer.hidden = true; send("mark"); }
  function discard() { fill([data.points, data.comment, ...data.each]); }

  function setPoints(button) {
    if (!button) return;
    points.value = button.dataset.points;
    share();
    points.focus();
  }

  /** Give each criterion its share of the points for all, rounded so that the sum stays; what is no share is refused. */
  function share() {
    const part = Number(points.value.replace(",", ".") || NaN) / data.maximum, units = /[.,]\d{3}/.test(points.value) ? 1e4 : 100;
    let sum = 0;
    for (const field of each) {
      const most = Number(field.dataset.most), before = Math.round(sum * part * units);
      sum += most;
      const own = (Math.round(sum * part * units) - before) / units;
      field.value = part === 1 ? most : part >= 0 && part < 1 ? Math.min(own, most) : points.value;
    }
  }

  function addUp() {
    const values = each.map((field) => Number(field.value.replace(",", ".") || NaN));
    const sum = values.reduce((total, value) => total + value, 0);
    points.value = Number.isNaN(sum) ? "" : Number(sum.toFixed(4));
  }

  const parts = () => comment.value.split(/(\s*[;\n]\s*)/);  // with what separates them
  const chosen = () => data.choices.filter(([text]) => parts().includes(text));
  const between = (value) => Number(Math.min(data.maximum, Math.max(0, value)).toFixed(4));
  const left = () => between(chosen().reduce((sum, [, cost]) => sum + cost, data.maximum));

  /** Add a usual deduction to the comment and take its cost from the points, or take both back. */
  function choose(number) {
    const choice = data.choices[number - 1];
    if (!choice) return;
    const [text, cost] = choice, at = parts().indexOf(text), given = Number(points.value.replace(",", ".") || NaN);
    const isTyped = !Number.isNaN(given) && given !== left();
    comment.value = at >= 0 ? parts().toSpliced(Math.min(at, Math.max(0, parts().length - 2)), 2).join("") : [text, ...comment.value ? [comment.value] : []].join("; ");
    points.value = isTyped ? between(given + (at >= 0 ? -cost : cost)) : left();
    points.focus();
    showChosen();
  }

  function showChosen() {
    const texts = chosen();
    for (const button of document.querySelectorAll("[data-choice]")) button.ariaPressed = String(texts.includes(data.choices[button.dataset.choice - 1]));
  }

  function loadFrame(details) {
    for (const frame of details.querySelectorAll("iframe[data-src]")) {
      if (details.open && !frame.src) frame.src = frame.dataset.src;
    }
  }

  let before = document.body, isTabbed = false;  // the last element with the focus, and whether Tab was pressed last

  /** Take the focus back from a document that took it when it was shown, as the viewer does for a damaged PDF. */
  function takeBack() {
    const frame = document.activeElement;
    if (!(frame instanceof HTMLIFrameElement) || frame.matches(":hover") || isTabbed) return;
    frame.blur();
    window.focus();
    before.focus({ preventScroll: true });
  }

  function toggle(selector) {
    const details = document.querySelector(selector);
    if (!details) return;
    details.open = !details.open;
    details.scrollIntoView({ block: "nearest" });
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
    q: () => send("question"), "/": searchPeople,
    n: () => send("next"), s: () => send("next"), b: () => send("back"), z: zoom,
    f: () => setPoints(buttons.at(-1)), h: () => setPoints(buttons.find((button) => button.dataset.name === "half")),
    d: () => toggle(".document"), g: () => find("space-ghost")?.click(),
    c: () => comment.focus(), p: () => points.select(), "?": () => help.showModal(),
    k: () => { if (!newer.hidden) keep(); }, r: () => { if (!newer.hidden) replace(); },
  };
  const keysOfEnd = { b: keys.b, "/": searchPeople };

  function onKey(event) {
    if (event.ctrlKey || event.metaKey || event.isComposing || (event.altKey && !isChoice(event))) return;
    const { key, code, altKey, shiftKey, repeat } = event;
    const pressed = { key, code, altKey, shiftKey, repeat };
    if (busy ? typed.push(pressed) : act(pressed, event.target)) event.preventDefault();
  }

  const isChoice = (event) => event.altKey && /^Digit[1-9]$/.test(event.code);

  /** Do what a key means; return whether it means anything but itself. */
  function act(event, target) {
    const isOther = event.key.length === 1 && event.key > "~" && event.code.startsWith("Key");  // a layout without Latin letters
    const key = isOther ? event.code.slice(3).toLowerCase() : event.key.length === 1 ? event.key.toLowerCase() : event.key;
    if (event.altKey) {
      if (form && !help.open && !large.open && !event.repeat) choose(Number(event.code.slice(-1)));
      return true;
    }
    if (help?.open) {
      if (key === "?") help.close();
      return key === "?";
    }
    if (large?.open) {
      const steps = { z: zoom, ArrowRight: () => enlarge(current + 1), ArrowLeft: () => enlarge(current - 1) };
      steps[key]?.();
      return key in steps;
    }
    if (target === find("find")) {
      if (key === "Enter") find("people-list").querySelector("button")?.click();
      return key === "Enter";
    }
    const isField = target === points || target === comment || each?.includes(target);
    if (key === "Escape" && isField) { target.blur(); return true; }
    if (key === "Enter" && form && (isField || target === document.body) && !(event.shiftKey && target === comment)) {
      if (!event.repeat) send("mark", event.shiftKey ? { to: "question" } : {});
      return true;
    }
    if (target === comment || target instanceof HTMLSelectElement) return false;
    if (key === "/" && isField && target.value && target.selectionStart === target.selectionEnd) return false;  // 1/2
    const action = (form ? keys : keysOfEnd)[key];
    if (action) {
      if (!event.repeat) action();
      return true;
    }
    if (form && !isField && key === "0") {
      setPoints(buttons[0]);
      return true;
    }
    return isField && /^[a-z]$/.test(key);
  }

  /** Prepare the page that is shown. */
  function start() {
    data = JSON.parse(find("data").textContent);
    [form, points, comment, error, newer] = ["form", "points", "comment", "error", "newer"].map(find);
    [large, picture, help] = ["large", "large-picture", "help"].map(find);
    pictures = [...document.querySelectorAll("[data-picture]")];
    buttons = [...document.querySelectorAll("[data-points]")];
    each = [...document.querySelectorAll("[data-most]")];
    [shown, leaving, current] = [data.shown, "", 0];
    for (const button of document.querySelectorAll("[data-do]")) button.addEventListener("click", () => send(button.dataset.do));
    const filters = [...document.querySelectorAll("[data-filter]")];
    const wanted = () => Object.fromEntries([["criterion", ""], ["section", ""], ["state", ""], ...filters.map((list) => [list.dataset.filter, list.value])]);
    for (const list of filters) list.addEventListener("change", () => send("filter", wanted()));
    if (!form) return;
    discard();
    form.addEventListener("submit", (event) => { event.preventDefault(); send("mark"); });
    for (const button of buttons) button.addEventListener("click", () => setPoints(button));
    for (const button of document.querySelectorAll("[data-choice]")) button.addEventListener("click", () => choose(button.dataset.choice));
    for (const details of document.querySelectorAll(".document")) {
      details.addEventListener("toggle", () => loadFrame(details));
      loadFrame(details);
    }
    points.addEventListener("input", share);
    for (const field of each) field.addEventListener("input", addUp);
    comment.addEventListener("input", showChosen);
    showChosen();
    pictures.forEach((button, number) => button.addEventListener("click", () => enlarge(number)));
    large.addEventListener("click", zoom);
    find("keep").addEventListener("click", keep);
    find("replace").addEventListener("click", replace);
    find("help-button").addEventListener("click", () => help.showModal());
    points.focus({ preventScroll: true });
    points.select();
  }

  document.addEventListener("keydown", onKey);
  document.addEventListener("keydown", ({ key }) => { isTabbed = key === "Tab"; }, true);
  document.addEventListener("focusin", ({ target }) => { if (!(target instanceof HTMLIFrameElement)) before = target; });
  addEventListener("blur", () => setTimeout(takeBack));
  addEventListener("popstate", () => location.reload());
  find("find").addEventListener("input", listPeople);
  start();
  loadPeople();
}
