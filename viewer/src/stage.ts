/** The picture: mandrel, bands, machine, marker; what it shows follows from a moment. */
import {
    Box3,
    BufferGeometry,
    Group,
    Line,
    LineBasicMaterial,
    Matrix4,
    Mesh,
    MeshBasicMaterial,
    RingGeometry,
    Vector2,
    Vector3,
} from 'three';
import type { Material } from 'three';
import { Bands } from './bands';
import type { CameraMode } from './cameraMode';
import { kBare } from './colour';
import type { Colouring } from './colour';
import type { CourseRange } from './courseRange';
import type { Page } from './data';
import { element } from './dom';
import { Framing } from './framing';
import type { Kinematics, Pose } from './kinematics';
import { bodyMaterial, MachineView, meshGeometry } from './machineView';
import { Mandrel } from './mandrel';
import { Measure } from './measure';
import { Picker } from './picking';
import type { Drawn, Hit } from './picking';
import { View } from './scene';
import { Section } from './section';
import { nearestNormal } from './shape';
import { cssVariable } from './theme';
import type { Landing, Moment, Timeline } from './timeline';
import { TravelBox } from './travelBox';
import { Triad } from './triad';


/** From where the whole is first seen, in the machine's axes: from above, the arm to the right. */
const kFirstView = new Vector3(0.6, 0.65, 0.48);
const kIdleMs = 400; // after which what is not seen at once is prepared
const kCloseWidths = 26; // distance of the camera from a place, in widths of the band

export class Stage {
    readonly view: View;
    readonly section: Section;
    readonly measure: Measure;
    readonly travel: TravelBox;
    mode: CameraMode = 'machine';
    private readonly mandrel: Mandrel;
    private readonly onMandrel = new Group(); // all that turns with the mandrel
    private readonly machine: MachineView;
    private readonly bands: Bands[];
    private readonly extension: Mesh | null = null;
    private readonly marker: Mesh;
    private readonly picker: Picker;
    private readonly framing: Framing;
    private readonly triad: Triad;
    private shown: Drawn[] = [];
    private pose: Pose | null = null;
    private layer: number | null = null;

    constructor(
        private readonly page: Page,
        private readonly kinematics: Kinematics,
        private readonly timeline: Timeline,
        private readonly range: CourseRange,
        canvas: HTMLCanvasElement,
    ) {
        const width = page.header.tow.width_mm;
        this.view = new View(canvas, kinematics.up());
        this.mandrel = new Mandrel(page);
        this.machine = new MachineView(page, kinematics.machine, width);
        this.bands = timeline.programs.map((p) => new Bands(p.fibre, width, p.index));
        this.onMandrel.matrixAutoUpdate = false;
        this.onMandrel.add(this.mandrel.group, ...this.bands.map((b) => b.mesh));
        if (page.extension) {
            const { points, faces } = page.extension;
            const material = bodyMaterial();
            material.polygonOffset = true;
            material.polygonOffsetFactor = material.polygonOffsetUnits = 1;
            this.extension = new Mesh(meshGeometry(points, faces), material);
            this.onMandrel.add(this.extension);
        }
        this.marker = this.makeMarker(width);
        const solids = [this.mandrel.mesh, ...(this.extension ? [this.extension] : [])];
        const extent = new Box3();
        for (const solid of solids) extent.expandByObject(solid);
        this.measure = new Measure(extent.getSize(new Vector3()).length());
        this.onMandrel.add(this.marker, this.makeAxis(), this.measure.group);
        this.section = new Section(extent, [
            ...this.mandrel.materials(),
            ...this.bands.map((b) => b.mesh.material),
            ...(this.extension ? [this.extension.material as Material] : []),
        ]);
        this.travel = new TravelBox(kinematics, timeline);
        this.view.world.add(this.onMandrel, this.machine.group, this.machine.fibre, this.travel.lines);
        this.framing = new Framing(page, kinematics, timeline);
        this.triad = new Triad(element('triad'), kinematics.axes);
        this.triad.setFrame(this.mode);
        this.view.afterRender = () => this.triad.turn(this.view.camera.quaternion);
        this.view.onResize = () => {
            if (!this.view.fitted) return;
            this.fit();
            this.view.render();
        };
        this.picker = new Picker(this.mandrel.mesh, this.extension, width);
        window.setTimeout(() => this.picker.prepare(timeline.programs.map((p) => p.fibre)), kIdleMs);
        this.setTheme();
    }

    setTheme(): void {
        this.view.setBackground(cssVariable('--sky'));
        this.mandrel.setTheme(
            cssVariable('--mandrel'),
            cssVariable('--mandrel-other'),
            cssVariable('--mandrel-edge'),
        );
        this.machine.setTheme(cssVariable('--machine'), cssVariable('--eye'), cssVariable('--fibre'));
        this.measure.setTheme(cssVariable('--text'));
        this.travel.setTheme(cssVariable('--muted'));
        const material = this.extension?.material as ReturnType<typeof bodyMaterial> | undefined;
        material?.uniforms.colour.value.setStyle(cssVariable('--extension'), '');
        this.view.request();
    }

    /** Which layer's mandrel and values are shown; null: all layers on the bare mandrel. */
    setLayer(layer: number | null): void {
        this.layer = layer;
        this.mandrel.show(layer);
        this.view.request();
    }

    setColouring(by: Colouring): void {
        this.mandrel.colour(by);
        for (const band of this.bands) {
            band.colour(by);
            band.mesh.userData.hidden = by.perFace !== null;
        }
        this.view.request();
    }

    showMachine(on: boolean): void {
        this.machine.group.visible = this.machine.fibre.visible = on;
        if (this.view.fitted) this.fit();
        this.view.request();
    }

    showBare(on: boolean): void {
        this.mandrel.showBare(on);
        this.view.request();
    }

    update(moment: Moment, pose: Pose, landing: Landing | null): void {
        this.pose = pose;
        this.onMandrel.matrix.copy(pose.baseFromMandrel);
        this.onMandrel.matrixWorldNeedsUpdate = true;
        this.machine.update(pose, landing);
        this.shown = [];
        this.timeline.programs.forEach((program, i) => {
            const band = this.bands[i];
            const visible = this.layer === null || program.fibre.layer === this.layer;
            const done =
                i < moment.program.index
                    ? Infinity
                    : i > moment.program.index
                      ? 0
                      : moment.time >= program.end
                        ? Infinity
                        : (landing?.station ?? moment.station);
            const { from, to } = this.range.stationsOf(program);
            const end = Math.min(to, done);
            band.show(from, end);
            if (!visible || band.mesh.userData.hidden) band.mesh.visible = false;
            if (visible && end > from) this.shown.push({ fibre: program.fibre, from, to: end });
        });
        this.place();
    }

    setMode(mode: CameraMode): void {
        if (mode === this.mode) return;
        this.mode = mode;
        this.triad.setFrame(mode);
        this.place();
        const arm = this.kinematics.up().z > 0.5;
        if (arm || this.view.fitted) this.fit();
    }

    private place(): void {
        if (!this.pose) return;
        const matrix = this.mode === 'machine' ? new Matrix4() : this.pose.baseFromMandrel.clone().invert();
        this.view.setWorld(matrix);
        this.placeSection();
    }

    /** Cuts where the section stands now. */
    placeSection(): void {
        this.view.world.updateMatrixWorld();
        this.section.place(this.onMandrel.matrixWorld);
        this.view.request();
    }

    fit(): void {
        this.view.resize();
        this.view.fit(this.framing.points(this.mode, this.machine.group.visible), kFirstView);
    }

    /** Where part and head are seen now: left, right, lower and upper end, -1..1 across the picture. */
    inPicture(): { part: number[]; head: number[] } {
        const pose = this.pose as Pose;
        this.view.world.updateMatrixWorld();
        this.view.camera.updateMatrixWorld();
        const ends = (points: Vector3[]): number[] => {
            const seen = points.map((p) => p.applyMatrix4(this.view.world.matrix).project(this.view.camera));
            const [x, y] = [seen.map((p) => p.x), seen.map((p) => p.y)];
            return [Math.min(...x), Math.max(...x), Math.min(...y), Math.max(...y)];
        };
        return { part: ends(this.framing.partAt(pose)), head: ends(this.framing.headAt(pose)) };
    }

    /** Flies to a place of the mandrel frame and marks it. */
    flyTo(place: Vector3): void {
        const normal = nearestNormal(this.page, place);
        const width = this.page.header.tow.width_mm;
        this.marker.visible = true;
        this.marker.position.copy(place).addScaledVector(normal, 0.15 * width);
        this.marker.quaternion.setFromUnitVectors(new Vector3(0, 0, 1), normal);
        this.onMandrel.updateWorldMatrix(true, true);
        const world = place.clone().applyMatrix4(this.onMandrel.matrixWorld);
        const direction = normal.clone().transformDirection(this.onMandrel.matrixWorld);
        // A little from the side, so that the surface reads; never straight along "up".
        direction.addScaledVector(this.view.camera.up, 0.25);
        if (Math.abs(direction.normalize().dot(this.view.camera.up)) > 0.97) {
            direction.add(new Vector3(0.3, 0, 0.3)).normalize();
        }
        this.view.flyTo(world, direction, kCloseWidths * width);
    }

    pick(at: Vector2): Hit | null {
        this.view.world.updateMatrixWorld();
        return this.picker.pick(at, this.view.camera, this.shown, this.section);
    }

    /** What the camera looks at, mandrel frame; where the marker is, if it is shown. */
    lookingAt(): Vector3 {
        this.view.world.updateMatrixWorld();
        return this.onMandrel.worldToLocal(this.view.controls.target.clone());
    }

    /** Turn of the drawn mandrel about its own z axis against its pose at zero, deg -180..180. */
    drawnTurn(): number {
        const zero = this.kinematics.pose(this.kinematics.axes.map(() => 0)).baseFromMandrel;
        const turned = zero.clone().invert().multiply(this.onMandrel.matrix).elements;
        return (Math.atan2(turned[1], turned[0]) * 180) / Math.PI;
    }

    private makeMarker(width: number): Mesh {
        const material = new MeshBasicMaterial({ depthTest: false, transparent: true });
        material.color.setStyle(kBare, '');
        const marker = new Mesh(new RingGeometry(1.3 * width, 1.55 * width, 48), material);
        marker.renderOrder = 1000;
        marker.visible = false;
        return marker;
    }

    /** The spindle axis, a little longer than the mandrel. */
    private makeAxis(): Line {
        const box = this.mandrel.mesh.geometry;
        box.computeBoundingBox();
        const [low, high] = [box.boundingBox?.min.z ?? -1, box.boundingBox?.max.z ?? 1];
        const over = 0.12 * (high - low);
        const geometry = new BufferGeometry();
        geometry.setFromPoints([new Vector3(0, 0, low - over), new Vector3(0, 0, high + over)]);
        const material = new LineBasicMaterial();
        material.color.setStyle('#8a94a0', '');
        return new Line(geometry, material);
    }
}
