/**
 * Links to a moment (#t=12.3, with &layer=2 for one layer alone, &courses=3-17 for a range of courses) and
 * `window.meshwind`:
 *   ready: Promise, fulfilled when the page is drawn
 *   seek(seconds): to a time of the common clock (all programs one after the other)
 *   state(): {time_s, program, block, axes, eye_mm (mandrel frame), spindle_deg, drawn_turn_deg, courses,
 *             camera: {position, target, target_mandrel_mm, part, head}, ...}
 * Both are part of the page's tests.
 */
import type { App } from './app';

const kQuietMs = 300;

export interface PageState {
    time_s: number;
    program: number; // index from 0
    block: number;
    station: number;
    axes: number[];
    eye_mm: number[];
    spindle_deg: number;
    drawn_turn_deg: number | null; // of the drawn mandrel, -180..180
    playing: boolean;
    colouring: string;
    layer: number | null; // from 1; null: all
    courses: [number, number]; // first and last drawn, of those shown in winding order, from 0
    mode: string;
    camera: {
        position: number[];
        target: number[];
        target_mandrel_mm: number[];
        part: number[]; // left, right, lower and upper end in the picture, -1..1
        head: number[];
    } | null;
}

export interface PageHook {
    ready: Promise<void>;
    seek: (seconds: number) => void;
    state: () => PageState;
}

declare global {
    interface Window {
        meshwind?: PageHook;
    }
}

export function stateOf(app: App): PageState {
    const { moment, pose, landing } = app;
    const stage = app.parts.stage;
    return {
        time_s: moment.time,
        program: moment.program.index,
        block: moment.block,
        station: landing?.station ?? moment.station,
        axes: [...moment.axes],
        eye_mm: pose.eyeMandrel.toArray(),
        spindle_deg: app.kinematics.spindle(moment.axes),
        drawn_turn_deg: stage ? stage.drawnTurn() : null,
        playing: app.playing,
        colouring: app.colouring.id,
        layer: app.layer === null ? null : app.layer + 1,
        courses: [app.range.first, app.range.last],
        mode: app.mode(),
        camera: stage && {
            position: stage.view.camera.position.toArray(),
            target: stage.view.controls.target.toArray(),
            target_mandrel_mm: stage.lookingAt().toArray(),
            ...stage.inPicture(),
        },
    };
}

export function followLink(app: App): boolean {
    const link = new URLSearchParams(location.hash.slice(1));
    const layer = Number(link.get('layer'));
    if (
        Number.isInteger(layer) &&
        layer >= 1 &&
        layer <= app.page.layers.length &&
        app.page.layers.length > 1
    ) {
        app.setLayer(layer - 1);
    }
    const courses = /^(\d+)-(\d+)$/.exec(link.get('courses') ?? '');
    if (courses) app.setRange(Number(courses[1]), Number(courses[2]));
    const time = link.get('t');
    if (time === null || !Number.isFinite(Number(time))) return false;
    app.pause();
    app.seek(Number(time));
    return true;
}

/** Keeps the address at the moment shown, once it rests. */
export class LinkKeeper {
    private timer = 0;
    private written = '';

    constructor(private readonly app: App) {
        window.addEventListener('hashchange', () => {
            if (location.hash !== this.written) followLink(app);
        });
    }

    note(): void {
        window.clearTimeout(this.timer);
        this.timer = window.setTimeout(() => this.write(), kQuietMs);
    }

    private write(): void {
        const { moment, layer, range, playing } = this.app;
        if (playing) return;
        const t = Number(moment.time.toFixed(3));
        const atEnd = layer === null && moment.time >= this.app.timeline.duration;
        const parts = [
            atEnd ? '' : `t=${t}`,
            layer === null ? '' : `layer=${layer + 1}`,
            range.isWhole() ? '' : `courses=${range.first}-${range.last}`,
        ].filter(Boolean);
        this.written = parts.length ? `#${parts.join('&')}` : '';
        if (this.written === location.hash) return;
        try {
            history.replaceState(null, '', this.written || location.pathname + location.search);
        } catch {
            // Some browsers forbid it on pages opened from a file; the page works without.
        }
    }
}
