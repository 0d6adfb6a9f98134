/** State of the page and what follows from it. */
import { Vector2, Vector3 } from 'three';
import type { CameraMode } from './cameraMode';
import { Checks } from './checks';
import type { Colouring, ColouringId } from './colour';
import { colouringsOf } from './colourings';
import type { CourseRange } from './courseRange';
import type { Courses } from './courses';
import type { Page } from './data';
import { hoverHtml } from './hover';
import type { Kinematics, Pose } from './kinematics';
import { legendHtml } from './legend';
import type { Listing } from './listing';
import type { Plots } from './plots';
import type { Stage } from './stage';
import { landingPoint } from './timeline';
import type { Landing, Moment, Program, Timeline } from './timeline';
import type { Place } from './types';

export interface Parts {
    stage: Stage | null; // null where WebGL is missing
    checks: Checks;
    courses: Courses;
    listing: Listing;
    plots: Plots;
    legend: HTMLElement;
    hover: HTMLElement;
}

export class App {
    /** Called whenever clock, layer, range, colouring, camera or playing have changed. */
    onChange: () => void = () => {};
    onLayer: () => void = () => {};
    layer: number | null = null; // index; null: all
    colourings: Colouring[];
    colouring: Colouring;
    playing = false;
    speed = 10;
    moment: Moment;
    pose: Pose;
    landing: Landing | null = null;
    private showBare = true;
    private lastFrame = 0;

    constructor(
        readonly page: Page,
        readonly timeline: Timeline,
        readonly kinematics: Kinematics,
        readonly range: CourseRange,
        readonly parts: Parts,
    ) {
        this.colourings = colouringsOf(page, null);
        this.colouring = this.colourings[0];
        this.moment = timeline.at(timeline.duration);
        this.pose = kinematics.pose(this.moment.axes);
    }

    mode(): CameraMode {
        return this.parts.stage?.mode ?? 'machine';
    }

    /** The stretch of the clock that is shown. */
    span(): { from: number; to: number } {
        const own = this.ownPrograms();
        return { from: own[0].start, to: own[own.length - 1].end };
    }

    private ownPrograms(): Program[] {
        const own = this.timeline.programs.filter((p) => this.layer === null || p.fibre.layer === this.layer);
        return own.length ? own : this.timeline.programs;
    }

    /** Goes to a time of the common clock, within what is shown. */
    seek(time: number, program?: Program): void {
        const { from, to } = this.span();
        const at = Math.min(Math.max(time, from), to);
        const own = this.ownPrograms();
        const under = program && own.includes(program) ? program : own.find((p) => at <= p.end);
        this.moment = this.timeline.at(at, under ?? own[own.length - 1]);
        this.pose = this.kinematics.pose(this.moment.axes);
        this.landing = landingPoint(this.moment.program.fibre, this.moment.station, this.pose.eyeMandrel);
        const { stage, plots, listing, courses } = this.parts;
        stage?.update(this.moment, this.pose, this.landing);
        plots.setTime(this.moment.time);
        listing.show(this.moment.program, this.moment.block);
        const { fibre } = this.moment.program;
        const station = Math.max(Math.floor(this.landing?.station ?? this.moment.station), 0);
        courses.mark(this.moment.program, fibre.piece[Math.min(station, fibre.piece.length - 1)]);
        this.onChange();
    }

    seekBlock(program: Program, block: number): void {
        this.pause();
        this.showProgram(program);
        this.seek(this.timeline.endOf(program, block), program);
    }

    /** Makes sure that a program is among those shown. */
    private showProgram(program: Program): void {
        if (this.layer !== null && this.layer !== program.fibre.layer) {
            this.setLayer(program.fibre.layer);
        }
    }

    stepBlock(by: 1 | -1): void {
        const { program, block, share } = this.moment;
        const last = program.fibre.time.length - 1;
        const target = by > 0 ? (share < 1 ? block : block + 1) : block - 1;
        if (target >= 0 && target <= last) this.seekBlock(program, target);
        else {
            const next = this.timeline.programs[program.index + by];
            if (next) this.seekBlock(next, by > 0 ? 0 : next.fibre.time.length - 1);
        }
    }

    play(): void {
        const { from, to } = this.span();
        if (this.moment.time >= to - 1e-9) this.seek(from, this.ownPrograms()[0]);
        this.playing = true;
        this.lastFrame = performance.now();
        requestAnimationFrame((now) => this.frame(now));
        this.onChange();
    }

    pause(): void {
        if (!this.playing) return;
        this.playing = false;
        this.onChange();
    }

    private frame(now: number): void {
        if (!this.playing) return;
        const passed = Math.min(Math.max(now - this.lastFrame, 0), 250) / 1000;
        this.lastFrame = now;
        const time = this.moment.time + passed * this.speed;
        const { to } = this.span();
        let program: Program | undefined = this.moment.program;
        if (time > program.end) program = undefined;
        if (time >= to) this.playing = false;
        this.seek(time, program);
        if (this.playing) requestAnimationFrame((next) => this.frame(next));
    }

    setLayer(layer: number | null): void {
        const id = this.colouring.id;
        this.layer = layer;
        this.range.show(layer);
        this.colourings = colouringsOf(this.page, layer);
        this.parts.stage?.setLayer(layer);
        this.parts.checks.show(layer);
        this.parts.courses.show(layer);
        const { from, to } = this.span();
        this.parts.plots.setWhole(from, to);
        this.setColouring(id);
        this.onLayer();
        this.seek(to);
    }

    /** Draws courses first to last of those shown. */
    setRange(first: number, last: number): void {
        this.range.set(first, last);
        this.seek(this.moment.time, this.moment.program);
    }

    setColouring(id: ColouringId): void {
        this.colouring = this.colourings.find((c) => c.id === id) as Colouring;
        this.parts.stage?.setColouring(this.colouring);
        this.drawLegend();
        this.seek(this.moment.time, this.moment.program);
    }

    setBare(on: boolean): void {
        this.showBare = on;
        this.parts.stage?.showBare(on);
        this.drawLegend();
    }

    setMode(mode: CameraMode): void {
        this.parts.stage?.setMode(mode);
        this.onChange();
    }

    /** Goes to the block of a place and flies there. */
    showPlace(place: Place): void {
        const program = this.timeline.programs.find(
            (p) => p.fibre.layer === (place.layer ?? 1) - 1 && p.fibre.fibre === (place.fibre ?? 1) - 1,
        );
        if (program && place.block !== undefined) this.seekBlock(program, Math.ceil(place.block / (program.fibre.header.block_every ?? 1)));
        if (place.position_mm) this.parts.stage?.flyTo(new Vector3(...place.position_mm));
    }

    hover(at: Vector2 | null): void {
        const { hover, stage } = this.parts;
        const hit = at && stage ? stage.pick(at) : null;
        hover.hidden = !hit;
        if (hit) hover.innerHTML = hoverHtml(this.page, hit, this.layer);
    }

    drawLegend(): void {
        const values = this.layer === null ? this.page.total : this.page.layers[this.layer].values;
        const bare = this.showBare && values.layers.some((v) => !(v > 0));
        const transitions = this.ownPrograms().some((p) =>
            p.fibre.header.pieces.some((piece) => piece.kind !== 'course'),
        );
        this.parts.legend.innerHTML = legendHtml(this.colouring, bare, transitions);
    }
}
