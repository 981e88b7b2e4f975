"use strict";
// A page of `grader view`: it waits for the next version, and shows it without being loaded again,
// with the camera, the sliders and what is chosen as they were.

/** @typedef {{number: number, address: string, isBroken: boolean, isStale: boolean}} Version */
/** @typedef {{page?: string, isEnded?: boolean}} Change */

{
  const find = (/** @type {string} */ id) =>
    /** @type {HTMLElement} */ (document.getElementById(id));
  const read = () => JSON.parse(find("data").textContent || "{}");
  const PARTS = ["view-robots", "view-arguments", "view-answers", "view-notes", "view-broken"];
  const MAX_LOG = 300_000; // characters, of which the last ones are read
  const STEPS = 65535; // of a coordinate of a mesh

  // --- Meshes ---
  /** @type {Map<string, Promise<Float32Array>>} */
  const meshes = new Map();
  /** Return triangles in a box of edges 1, as corners with normals. @param {ArrayBuffer} data */
  const trianglesOf = (data) => {
    const [steps, numbers] = [new DataView(data), new Float32Array(data.byteLength)];
    for (let i = 0; 18 * i < data.byteLength; i++) {
      const corners = [0, 1, 2].map((corner) =>
        [0, 1, 2].map((k) => steps.getUint16(18 * i + 6 * corner + 2 * k, true) / STEPS - 0.5),
      );
      const normal = Shapes.across(corners[0], corners[1], corners[2]);
      const length = Math.hypot(...normal) || 1;
      corners.forEach((point, corner) => {
        numbers.set([...point, ...normal.map((value) => value / length)], 18 * i + 6 * corner);
      });
    }
    return numbers;
  };
  const load = async (/** @type {string} */ address) => {
    const answer = await fetch(`mesh/${address}`);
    return trianglesOf(await answer.arrayBuffer());
  };
  /** Show the triangles of the meshes in place of their boxes, as they arrive. */
  const showMeshes = () => {
    const view = RobotView;
    /** @type {Set<string>} */
    const addresses = new Set(
      (read().robot?.links || []).flatMap((/** @type {Link} */ link) =>
        link.shapes.flatMap(({ mesh }) => mesh || []),
      ),
    );
    for (const address of [...meshes.keys()].filter((one) => !addresses.has(one))) {
      meshes.delete(address);
    }
    for (const address of addresses) {
      const loading = meshes.get(address) || load(address);
      meshes.set(address, loading);
      loading.then(
        (numbers) => {
          if (view && view === RobotView) {
            view.solids[address] = view.solid(numbers);
            view.render();
          }
        },
        () => meshes.delete(address), // its box is shown
      );
    }
  };

  // --- What stays when another version is shown ---
  const BUTTONS = ["space-ghost", "space-frames"];
  const openParts = () =>
    [...document.querySelectorAll("#main details")].filter(
      (one) => /** @type {HTMLDetailsElement} */ (one).open,
    );
  const nameOf = (/** @type {Element} */ details) =>
    details.querySelector("summary")?.textContent?.replace(/[\d.,/\s]+/g, " ");
  const keep = () => ({
    camera: { ...RobotView?.camera },
    positions: new Map(RobotView?.positions),
    link: /** @type {HTMLSelectElement | null} */ (find("space-links"))?.value || "",
    pressed: BUTTONS.map((id) => find(id)?.getAttribute("aria-pressed")),
    open: new Set(openParts().map(nameOf)),
    scroll: find("space-joints")?.scrollTop || 0,
  });
  const restore = (/** @type {ReturnType<typeof keep>} */ kept) => {
    for (const one of document.querySelectorAll("#main details")) {
      /** @type {HTMLDetailsElement} */ (one).open = kept.open.has(nameOf(one));
    }
    if (!RobotView) {
      return;
    }
    Object.assign(RobotView.camera, kept.camera);
    for (const { name, range, start = 0 } of read().robot.joints) {
      const position = kept.positions.get(name);
      if (range && position !== undefined && position !== start) {
        RobotView.move(name, Math.max(range[0], Math.min(range[1], position)));
      }
    }
    BUTTONS.forEach((id, number) => {
      if (kept.pressed[number] && find(id).getAttribute("aria-pressed") !== kept.pressed[number]) {
        find(id).click();
      }
    });
    if (RobotView.poses().has(kept.link)) {
      RobotView.select(kept.link);
    }
    RobotView.render();
    find("space-joints").scrollTop = kept.scroll;
  };
  /** Focus what is now in the place of an element. @param {Element | null} element */
  const focusAgain = (element) => {
    if (!element || element.isConnected) {
      return;
    }
    const titleOf = (/** @type {Element} */ input) =>
      input.closest("label")?.firstChild?.textContent;
    const inputs = document.querySelectorAll("#space-joints input, #view-arguments input");
    const found = element.id
      ? find(element.id)
      : [...inputs].find((input) => titleOf(input) === titleOf(element));
    /** @type {HTMLElement | null | undefined} */ (found)?.focus({ preventScroll: true });
  };

  // --- Versions ---
  const showCopies = () => {
    for (const button of document.querySelectorAll("button.copy")) {
      /** @type {HTMLButtonElement} */ (button).hidden = !navigator.clipboard;
    }
  };
  /** Return the parts of a page, which stay as they are. @param {Document} page */
  const partsOf = (page) =>
    new Map([...PARTS, "main"].map((id) => [id, page.getElementById(id)?.cloneNode(true)]));
  let served = partsOf(document);
  let played = showPlayback(0);
  const mark = () => {
    /** @type {Version} */
    const view = read().view;
    const [main, head] = [find("main"), document.querySelector("header.head")];
    main.classList.toggle("broken", view.isBroken && !view.isStale);
    for (const one of [main, head]) {
      one?.classList.toggle("stale", view.isStale);
    }
    if (view.isStale) {
      const count = find("view-broken").querySelectorAll(".card").length;
      const name = head?.querySelector("h1")?.textContent;
      document.title = `${count} ${count === 1 ? "problem" : "problems"}: ${name}`;
    }
  };
  /** Show a part of another page. @param {string} id @param {Document} page */
  const take = (id, page) => {
    const nodes = page.getElementById(id)?.childNodes || [];
    find(id).replaceChildren(...[...nodes].map((node) => document.adoptNode(node)));
  };
  const show = (/** @type {string} */ text) => {
    const page = new DOMParser().parseFromString(text, "text/html");
    const parts = partsOf(page);
    const isSame = (/** @type {string} */ id) => served.get(id)?.isEqualNode(parts.get(id) || null);
    const before = JSON.stringify(read().robot);
    const focus = document.activeElement;
    document.title = page.title;
    find("data").textContent = page.getElementById("data")?.textContent || "{}";
    document
      .querySelector("header.head")
      ?.replaceWith(document.adoptNode(/** @type {Element} */ (page.querySelector("header.head"))));
    for (const id of PARTS) {
      if (!isSame(id)) {
        take(id, page);
      }
    }
    if (!isSame("main") || JSON.stringify(read().robot) !== before) {
      const kept = keep();
      RobotView?.close();
      take("main", page);
      RobotView = showRobot();
      restore(kept);
      played = showPlayback(played?.time() || 0);
      showMeshes();
      showCopies();
    }
    served = parts;
    mark();
    focusAgain(focus);
  };
  const follow = async () => {
    for (;;) {
      /** @type {Version} */
      const { number, address } = read().view;
      const answer = await fetch(`changes/${number}/${address}`);
      /** @type {Change} */
      const change = await answer.json();
      if (change.isEnded) {
        return;
      }
      if (change.page) {
        show(change.page);
      }
    }
  };

  // --- Arguments of xacro ---
  const form = /** @type {HTMLFormElement} */ (find("view-arguments"));
  const send = async (/** @type {object} */ action, /** @type {string} */ to = "arguments") => {
    const headers = { "Content-Type": "application/json" };
    const request = { method: "POST", headers, body: JSON.stringify(action) };
    await fetch(to, request).catch(() => {}); // the page says that there is no connection
  };
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    /** @type {{[name: string]: string}} */
    const values = {};
    for (const field of form.querySelectorAll("input")) {
      if (field.value !== field.defaultValue) {
        values[field.name] = field.value;
      }
    }
    send({ do: "try", arguments: values });
  });
  form.addEventListener("reset", () => {
    send({ do: "reset" });
  });
  form.addEventListener("change", () => form.requestSubmit());

  // --- An output of the terminal ---
  const log = /** @type {HTMLFormElement} */ (find("view-log-form"));
  const text = /** @type {HTMLTextAreaElement} */ (find("view-log-text"));
  log.addEventListener("submit", (event) => {
    event.preventDefault();
    send({ do: "explain", log: text.value.slice(-MAX_LOG) }, "log");
  });
  log.addEventListener("reset", () => {
    send({ do: "clear" }, "log");
  });

  mark();
  showMeshes();
  follow()
    .catch(() => {}) // there is no connection
    .then(() => {
      find("view-ended").hidden = false;
    });
}
