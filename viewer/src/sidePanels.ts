/** Side panel and plots can be folded away and made larger or smaller; the tab of the browser keeps it. */
import { element } from './dom';

const kStep = 24; // px that an arrow key moves a border
const kMinPx = 120;
const kMaxShare = 0.65; // of the window

export type PanelId = 'side' | 'plots';

interface Kept {
    folded: boolean;
    size: number | null; // px; null: as the style has it
}

export class SidePanel {
    private readonly panel: HTMLElement;
    private readonly border: HTMLElement;
    private readonly kept: Kept;

    constructor(private readonly id: PanelId) {
        this.panel = element(id);
        this.border = this.panel.querySelector('.border') as HTMLElement;
        this.kept = recall(id);
        element(`fold-${id}`).addEventListener('click', () => this.toggle());
        this.border.addEventListener('pointerdown', (event) => this.drag(event));
        this.border.addEventListener('dblclick', () => this.resize(null));
        this.border.addEventListener('keydown', (event) => this.key(event));
        this.apply();
    }

    toggle(): void {
        this.kept.folded = !this.kept.folded;
        this.apply();
    }

    private size(): number {
        return this.id === 'side' ? this.panel.offsetWidth : this.panel.offsetHeight;
    }

    private most(): number {
        return kMaxShare * (this.id === 'side' ? window.innerWidth : window.innerHeight);
    }

    private resize(size: number | null): void {
        this.kept.size = size === null ? null : Math.round(Math.min(Math.max(size, kMinPx), this.most()));
        this.apply();
    }

    /** Both panels end at the right or the lower side of the window, so that they grow towards its start. */
    private drag(event: PointerEvent): void {
        if (event.button !== 0) return;
        event.preventDefault();
        this.border.setPointerCapture(event.pointerId);
        const along = (e: PointerEvent): number => (this.id === 'side' ? e.clientX : e.clientY);
        const sum = this.size() + along(event);
        const move = (e: PointerEvent): void => this.resize(sum - along(e));
        const end = (): void => this.border.removeEventListener('pointermove', move);
        this.border.addEventListener('pointermove', move);
        this.border.addEventListener('lostpointercapture', end, { once: true });
    }

    private key(event: KeyboardEvent): void {
        const keys = this.id === 'side' ? ['ArrowLeft', 'ArrowRight'] : ['ArrowUp', 'ArrowDown'];
        const at = keys.indexOf(event.key);
        if (at < 0) return;
        event.preventDefault();
        this.resize(this.size() + (at === 0 ? kStep : -kStep));
    }

    private apply(): void {
        const { folded, size } = this.kept;
        const { classList, style } = document.body;
        classList.toggle(`${this.id}-folded`, folded);
        element(`fold-${this.id}`).setAttribute('aria-expanded', String(!folded));
        if (size === null) style.removeProperty(`--${this.id}-size`);
        else style.setProperty(`--${this.id}-size`, `${size}px`);
        this.border.setAttribute('aria-valuemin', String(kMinPx));
        this.border.setAttribute('aria-valuemax', String(Math.round(this.most())));
        this.border.setAttribute('aria-valuenow', String(this.size()));
        keep(this.id, this.kept);
    }
}

function recall(id: PanelId): Kept {
    try {
        const { folded, size } = JSON.parse(sessionStorage.getItem(`meshwind-${id}`) ?? '{}') as Partial<Kept>;
        return { folded: folded === true, size: typeof size === 'number' ? size : null };
    } catch {
        return { folded: false, size: null };
    }
}

function keep(id: PanelId, kept: Kept): void {
    try {
        sessionStorage.setItem(`meshwind-${id}`, JSON.stringify(kept));
    } catch {
        // Some browsers forbid it on pages opened from a file; the page works without.
    }
}
