/** Renderer, camera and the flight of the camera; draws only when something has changed. */
import {
    Box3,
    Color,
    Group,
    LinearSRGBColorSpace,
    PerspectiveCamera,
    Scene,
    Vector3,
    WebGLRenderer,
} from 'three';
import type { Matrix4 } from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';

const kFieldOfViewDeg = 28;
const kFlightMs = 600;
const kMaxPixelRatio = 2;

export class View {
    readonly scene = new Scene();
    readonly world = new Group(); // base frame, or turned back so that the mandrel stands still
    readonly camera = new PerspectiveCamera(kFieldOfViewDeg, 1, 1, 1e5);
    readonly controls: OrbitControls;
    readonly renderer: WebGLRenderer;
    /** Called after each picture. */
    afterRender: () => void = () => {};
    /** Called when the picture has another size. */
    onResize: () => void = () => {};
    fitted = false; // as fit() left it: neither turned, moved nor flown since
    private wanted = false;
    private flight = 0; // number of the flight under way
    private radius = 100;

    /** Throws where WebGL is missing. */
    constructor(
        readonly canvas: HTMLCanvasElement,
        up: Vector3,
    ) {
        // The buffer is kept for printing and for reading the picture back.
        this.renderer = new WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
        this.renderer.localClippingEnabled = true;
        this.renderer.outputColorSpace = LinearSRGBColorSpace; // shaders write screen colours
        this.camera.up.copy(up);
        this.controls = new OrbitControls(this.camera, canvas);
        this.controls.rotateSpeed = 0.8;
        this.controls.zoomToCursor = true;
        this.controls.addEventListener('change', () => this.request());
        this.controls.addEventListener('start', () => this.leaveFit());
        this.world.matrixAutoUpdate = false;
        this.scene.add(this.world);
        new ResizeObserver(() => {
            this.resize();
            this.onResize();
        }).observe(canvas.parentElement as Element);
        this.resize();
    }

    setBackground(colour: string): void {
        this.scene.background = new Color().setStyle(colour, '');
        this.request();
    }

    setWorld(matrix: Matrix4): void {
        this.world.matrix.copy(matrix);
        this.world.matrixWorldNeedsUpdate = true;
        this.request();
    }

    request(): void {
        if (this.wanted) return;
        this.wanted = true;
        requestAnimationFrame(() => {
            if (this.wanted) this.render();
        });
    }

    render(): void {
        this.wanted = false;
        const distance = this.camera.position.distanceTo(this.controls.target);
        this.camera.near = Math.max(distance / 400, 0.2);
        this.camera.far = distance + 40 * this.radius + 4000;
        this.camera.updateProjectionMatrix();
        this.renderer.render(this.scene, this.camera);
        this.afterRender();
    }

    resize(): void {
        const host = this.canvas.parentElement as HTMLElement;
        const { clientWidth: width, clientHeight: height } = host;
        if (!width || !height) return;
        this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, kMaxPixelRatio));
        this.renderer.setSize(width, height, false);
        this.camera.aspect = width / height;
        this.camera.updateProjectionMatrix();
        this.render();
    }

    /**
     * Looks at all points (world frame) from a direction, as near as it can be.
     */
    fit(points: Vector3[], direction: Vector3): void {
        const forward = direction.clone().normalize().negate();
        const right = forward.clone().cross(this.camera.up).normalize();
        const upward = right.clone().cross(forward);
        const vertical = Math.tan((kFieldOfViewDeg * Math.PI) / 360);
        const horizontal = vertical * this.camera.aspect;
        const target = new Box3().setFromPoints(points).getCenter(new Vector3());
        let distance = 0;
        for (let round = 0; round < 4; ++round) {
            // Nearest distance for this target, then the target moved into the picture's middle.
            const ends = [Infinity, -Infinity, Infinity, -Infinity];
            distance = 0;
            for (const point of points) {
                const p = point.clone().sub(target);
                const [x, y, z] = [p.dot(right), p.dot(upward), p.dot(forward)];
                distance = Math.max(distance, Math.abs(x) / horizontal - z, Math.abs(y) / vertical - z);
                ends[0] = Math.min(ends[0], x);
                ends[1] = Math.max(ends[1], x);
                ends[2] = Math.min(ends[2], y);
                ends[3] = Math.max(ends[3], y);
            }
            target.addScaledVector(right, (ends[0] + ends[1]) / 2);
            target.addScaledVector(upward, (ends[2] + ends[3]) / 2);
        }
        this.radius = Math.max(...points.map((p) => p.distanceTo(target)), 1);
        this.leaveFit();
        this.fitted = true;
        this.controls.target.copy(target);
        this.camera.position.copy(target).addScaledVector(forward, -1.1 * distance);
        this.controls.update();
        this.request();
    }

    /** \return number of the flight that may begin; any other has ended */
    private leaveFit(): number {
        this.fitted = false;
        return ++this.flight;
    }

    /** Flies until a place (world frame) is seen along `-direction` from `distance`. */
    flyTo(target: Vector3, direction: Vector3, distance: number): void {
        const flight = this.leaveFit();
        const eyeFrom = this.camera.position.clone();
        const targetFrom = this.controls.target.clone();
        const eyeTo = target.clone().addScaledVector(direction.clone().normalize(), distance);
        const still = matchMedia('(prefers-reduced-motion: reduce)').matches;
        const start = performance.now();
        const step = (): void => {
            if (flight !== this.flight) return;
            const t = still ? 1 : Math.min((performance.now() - start) / kFlightMs, 1);
            const eased = t * t * (3 - 2 * t);
            this.controls.target.lerpVectors(targetFrom, target, eased);
            this.camera.position.lerpVectors(eyeFrom, eyeTo, eased);
            this.controls.update();
            this.request();
            if (t < 1) requestAnimationFrame(step);
        };
        step();
    }
}
