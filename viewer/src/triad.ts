/** The axes of the frame that the camera stands in, in the corner of the picture. */
import { Quaternion, Vector3 } from 'three';
import type { CameraMode } from './cameraMode';
import type { Axis } from './types';

const kNames = ['X', 'Y', 'Z'];
const kUnits = [new Vector3(1, 0, 0), new Vector3(0, 1, 0), new Vector3(0, 0, 1)];
const kLength = 30; // of an arrow, of the 100 that the drawing is wide
const kLetter = 41; // where its letter stands
const kAway = '0.6'; // opacity of what points away from the viewer

export class Triad {
    private readonly arrows: { group: SVGGElement; line: SVGLineElement; letter: SVGTextElement }[];
    private readonly drawing: SVGSVGElement;
    private readonly caption: HTMLElement;
    private readonly drawn = new Quaternion(0, 0, 0, 0);

    constructor(
        private readonly host: HTMLElement,
        private readonly axes: Axis[],
    ) {
        host.hidden = false;
        this.drawing = host.querySelector('svg') as SVGSVGElement;
        this.caption = host.querySelector('figcaption') as HTMLElement;
        this.drawing.innerHTML = kNames
            .map((name) => `<g class="axis-${name.toLowerCase()}"><line/><text>${name}</text></g>`)
            .join('');
        this.arrows = [...this.drawing.querySelectorAll('g')].map((group) => ({
            group,
            line: group.firstChild as SVGLineElement,
            letter: group.lastChild as SVGTextElement,
        }));
    }

    setFrame(mode: CameraMode): void {
        const words = mode === 'machine' ? ['machine', ...otherLetters(this.axes)] : ['mandrel'];
        this.caption.textContent = words.join('\n');
        this.host.setAttribute('aria-label', `Axes X, Y and Z of the ${words.join(', ')}`);
    }

    /** \param camera where it looks, in the frame that it stands in */
    turn(camera: Quaternion): void {
        if (this.drawn.equals(camera)) return;
        this.drawn.copy(camera);
        const back = camera.clone().invert();
        const seen = kUnits.map((unit) => unit.clone().applyQuaternion(back));
        seen.forEach(({ x, y, z }, i) => {
            const { group, line, letter } = this.arrows[i];
            line.setAttribute('x2', (kLength * x).toFixed(2));
            line.setAttribute('y2', (-kLength * y).toFixed(2));
            letter.setAttribute('x', (kLetter * x).toFixed(2));
            letter.setAttribute('y', (-kLetter * y).toFixed(2));
            group.setAttribute('opacity', z < -0.05 ? kAway : '1');
        });
        // The nearest one is drawn last, over the others.
        const order = [0, 1, 2].sort((a, b) => seen[a].z - seen[b].z);
        this.drawing.append(...order.map((i) => this.arrows[i].group));
    }
}

/** Linear axes of the machine whose letter is not that of the direction they move in. */
function otherLetters(axes: Axis[]): string[] {
    return axes.flatMap(({ letter, type, direction }) => {
        const along = direction.findIndex((c) => Math.abs(c) > 0.999);
        if (type !== 'linear' || along < 0) return [];
        const name = `${direction[along] < 0 ? '\u2212' : ''}${kNames[along]}`;
        return name === letter ? [] : [`axis ${letter} along ${name}`];
    });
}
