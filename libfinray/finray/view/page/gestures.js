// The cursor and a selection: elements above all plots, so that no canvas is drawn while they move.
class Cursor {
  constructor(parent, view) {
    this.parent = parent;
    this.view = view;
    this.line = document.createElement("div");
    this.line.className = "cursor";
    this.area = document.createElement("div");
    this.area.className = "selection";
    this.area.hidden = true;
    parent.append(this.area, this.line);
  }
  draw(width) {
    const {cursor, t0, t1} = this.view, share = (cursor - t0) / (t1 - t0);
    this.line.hidden = !(share >= -1e-9 && share <= 1 + 1e-9);
    this.line.style.transform = `translateX(${Math.round(LEFT + (width - LEFT - RIGHT) * share)}px)`;
  }
  select(x0, x1) {
    this.area.hidden = x0 === undefined;
    if (this.area.hidden) return;
    this.area.style.left = Math.min(x0, x1) + "px";
    this.area.style.width = Math.abs(x1 - x0) + "px";
  }
}

// Scrub, zoom and pan by mouse, pen and fingers.
function listen(plot, view, actions) {
  const element = plot.area, down = new Map();
  let pinch = null, selection = null;
  const place = event => event.clientX - element.getBoundingClientRect().left;
  element.addEventListener("pointerdown", event => {
    element.setPointerCapture(event.pointerId);
    down.set(event.pointerId, place(event));
    if (down.size === 2) {
      const [a, b] = [...down.values()];
      pinch = {width: Math.max(10, Math.abs(a - b)), span: view.t1 - view.t0, t: plot.t((a + b) / 2)};
    } else if (event.shiftKey) {
      selection = {x0: place(event), x1: place(event)};
    } else {
      actions.scrub(plot.t(place(event)));
    }
  });
  element.addEventListener("pointermove", event => {
    if (!down.has(event.pointerId)) return;
    down.set(event.pointerId, place(event));
    if (pinch && down.size === 2) {
      const [a, b] = [...down.values()];
      const span = Math.min(view.most - view.least, pinch.span * pinch.width / Math.max(10, Math.abs(a - b)));
      view.show(pinch.t - ((a + b) / 2 - LEFT) / (plot.width - LEFT - RIGHT) * span, span);
      actions.redraw();
    } else if (selection) {
      selection.x1 = place(event);
      actions.select(selection.x0, selection.x1);
    } else if (!pinch) {
      actions.scrub(plot.t(place(event)));
    }
  });
  const up = event => {
    if (selection && Math.abs(selection.x1 - selection.x0) > 4) {
      const [a, b] = [plot.t(selection.x0), plot.t(selection.x1)].sort((p, q) => p - q);
      view.show(a, b - a);
      actions.redraw();
    }
    selection = null;
    actions.select();
    down.delete(event.pointerId);
    if (down.size === 0) pinch = null;
  };
  element.addEventListener("pointerup", up);
  element.addEventListener("pointercancel", up);
  element.addEventListener("dblclick", () => { view.all(); actions.redraw(); });
  element.addEventListener("wheel", event => {
    if (!event.ctrlKey && !event.metaKey && !event.shiftKey) return;  // the page scrolls
    event.preventDefault();
    if (event.shiftKey) {
      const span = view.t1 - view.t0;
      view.show(view.t0 + span * (event.deltaX + event.deltaY) / 800, span);
    } else {
      view.zoom(Math.exp(event.deltaY * 0.002), plot.t(place(event)));
    }
    actions.redraw();
  }, {passive: false});
}
