/** Words over the picture that keep to places of the part and apart from one another. */
import { Vector3 } from 'three';
import type { PerspectiveCamera } from 'three';

export interface Label {
    id: string; // "rim-0", "remark-2"
    kind: 'rim' | 'spindle' | 'remark';
    words: string;
    title: string;
    at: Vector3;
    normal: Vector3 | null; // of the surface there; faint when it faces away
}

const kGap = 3; // pixels between labels

export class Labels {
    onClick: (label: Label) => void = () => {};
    onHover: (label: Label | null) => void = () => {};
    private readonly boxes: { label: Label; box: HTMLElement; width: number; height: number }[];

    constructor(
        private readonly host: HTMLElement,
        labels: Label[],
    ) {
        this.boxes = labels.map((label) => {
            const box = document.createElement('button');
            box.type = 'button';
            box.className = `label ${label.kind}`;
            box.dataset.label = label.id;
            box.textContent = label.words;
            box.title = label.title;
            box.tabIndex = -1; // the lists beside lead to the same
            box.addEventListener('click', () => this.onClick(label));
            box.addEventListener('pointerenter', () => this.onHover(label));
            box.addEventListener('pointerleave', () => this.onHover(null));
            host.append(box);
            return { label, box, width: box.offsetWidth, height: box.offsetHeight };
        });
    }

    all(): Label[] {
        return this.boxes.map(({ label }) => label);
    }

    show(on: boolean): void {
        this.host.hidden = !on;
    }

    /** Marks the labels whose id begins so; empty: none. */
    choose(id: string): void {
        for (const { label, box } of this.boxes) box.classList.toggle('here', label.id === id);
    }

    place(camera: PerspectiveCamera): void {
        const { clientWidth: width, clientHeight: height } = this.host;
        const taken: { x: number; y: number; w: number; h: number }[] = [];
        for (const { label, box, width: w, height: h } of this.boxes) {
            const p = label.at.clone().project(camera);
            const seen = p.z < 1 && Math.abs(p.x) < 1 && Math.abs(p.y) < 1;
            box.hidden = !seen;
            if (!seen) continue;
            const x = Math.min(Math.max(((p.x + 1) / 2) * width - w / 2, 0), width - w);
            let y = Math.min(Math.max(((1 - p.y) / 2) * height - h / 2, 0), height - h);
            const inTheWay = () =>
                taken.find((t) => x < t.x + t.w + kGap && t.x < x + w + kGap && y < t.y + t.h + kGap && t.y < y + h + kGap);
            for (let hit = inTheWay(), n = 0; hit && n < this.boxes.length; hit = inTheWay(), ++n) {
                y = hit.y + hit.h + kGap;
            }
            taken.push({ x, y, w, h });
            box.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
            const away = label.normal && label.normal.dot(camera.position.clone().sub(label.at)) < 0;
            box.classList.toggle('far', Boolean(away));
        }
    }
}
