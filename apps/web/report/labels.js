// Short texts that stand at points of the structure: an overlay of the canvas, placed anew whenever the view is drawn.
import * as THREE from 'three';

const MOST = 24;  // more would hide each other

export class Labels {
  constructor(canvas) {
    this.layer = document.createElement('div');
    this.layer.id = 'labels';
    canvas.parentElement.append(this.layer);
    this.groups = new Map();
    this.places = [];
  }

  /** list: [{at: [x, y, z], text}]; of a long one only the first are shown. A group replaces the one of its name. */
  set(group, list) {
    this.groups.set(group, list.slice(0, MOST));
    this.places = [];
    this.layer.replaceChildren();
    for (const [name, labels] of this.groups)
      for (const { at, text } of labels) {
        const element = document.createElement('span');
        element.className = name;
        element.textContent = text;
        this.layer.append(element);
        this.places.push({ element, at: new THREE.Vector3(...at) });
      }
  }

  place(camera) {
    const { clientWidth: w, clientHeight: h } = this.layer;
    for (const { element, at } of this.places) {
      const p = at.clone().project(camera);
      element.hidden = p.z > 1 || Math.abs(p.x) > 1 || Math.abs(p.y) > 1;
      element.style.transform = `translate(${((p.x + 1) * w / 2).toFixed(1)}px, ${((1 - p.y) * h / 2).toFixed(1)}px)`;
    }
  }
}
