/** What the pages do with their elements. */
import { Vector2 } from 'three';

export function element<T extends HTMLElement = HTMLElement>(id: string): T {
    return document.getElementById(id) as T;
}

/** One line over the page. */
export function notice(text: string): void {
    const line = element('notice');
    line.hidden = false;
    line.textContent = text;
}

export function option(value: string, label: string): HTMLOptionElement {
    const result = document.createElement('option');
    result.value = value;
    result.textContent = label;
    return result;
}

/** A box to tick, by a key as well. */
export function box(id: string, key: string, onChange: (on: boolean) => void): void {
    const input = element<HTMLInputElement>(id);
    input.addEventListener('change', () => onChange(input.checked));
    window.addEventListener('keydown', (event) => {
        if (event.ctrlKey || event.metaKey || event.altKey || event.key.toLowerCase() !== key) return;
        input.checked = !input.checked;
        onChange(input.checked);
    });
}

/** Whether there is WebGL 2; else the page goes on without its picture. */
export function canDraw(): boolean {
    const probe = document.createElement('canvas').getContext('webgl2');
    probe?.getExtension('WEBGL_lose_context')?.loseContext();
    if (!probe) document.body.classList.add('no-picture');
    return probe !== null;
}

/**
 * Calls once a frame at most with the place under the pointer, -1..1 both ways; null: none, or a
 * button is down.
 * \return calls again for the place as it was
 */
export function followPointer(canvas: HTMLElement, look: (at: Vector2 | null) => void): () => void {
    let next: Vector2 | null = null;
    let waiting = false;
    const lookSoon = (): void => {
        if (waiting) return;
        waiting = true;
        requestAnimationFrame(() => {
            waiting = false;
            look(next);
        });
    };
    canvas.addEventListener('pointermove', (event) => {
        const box = canvas.getBoundingClientRect();
        next = event.buttons
            ? null
            : new Vector2(
                  ((event.clientX - box.left) / box.width) * 2 - 1,
                  1 - ((event.clientY - box.top) / box.height) * 2,
              );
        lookSoon();
    });
    canvas.addEventListener('pointerleave', () => {
        next = null;
        look(null);
    });
    return () => {
        if (next) lookSoon();
    };
}
