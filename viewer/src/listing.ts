/** The NC program: only the lines in sight are in the page. */
import { escapeHtml } from './format';
import type { Program } from './timeline';

const kRowPx = 19;
const kBeyond = 12; // rows drawn above and below what is in sight

export class Listing {
    onSeek: (program: Program, block: number) => void = () => {};
    private readonly spacer = document.createElement('div');
    private readonly rows = document.createElement('div');
    private program: Program | null = null;
    private lines: Uint32Array = new Uint32Array(0); // where each line begins; one more at the end
    private blocksOfLine = new Map<number, number[]>();
    private current = 0; // line under way, from 1; 0 none
    private block = 0;
    private readonly decoder = new TextDecoder();

    constructor(
        private readonly host: HTMLElement,
        private readonly title: HTMLElement,
    ) {
        host.classList.add('listing');
        host.tabIndex = 0;
        host.setAttribute('role', 'listbox');
        host.setAttribute('aria-label', 'Lines of the program');
        this.rows.className = 'listing-rows';
        this.spacer.append(this.rows);
        host.append(this.spacer);
        host.addEventListener('scroll', () => this.draw(), { passive: true });
        new ResizeObserver(() => this.centre()).observe(host);
        host.addEventListener('click', (event) => {
            const row = (event.target as HTMLElement).closest<HTMLElement>('[data-line]');
            if (row) this.choose(Number(row.dataset.line));
        });
    }

    show(program: Program, block: number): void {
        this.block = block;
        if (program !== this.program) this.load(program);
        const line = this.program?.fibre.line[block] ?? 0;
        if (line === this.current && line !== 0) return;
        this.current = line;
        this.centre();
    }

    private load(program: Program): void {
        this.program = program;
        this.current = -1;
        const { text, line, header } = program.fibre;
        const begins = [0];
        for (let i = 0; i < text.length; ++i) if (text[i] === 10 && i + 1 < text.length) begins.push(i + 1);
        this.lines = Uint32Array.from(text.length ? [...begins, text.length + 1] : []);
        this.blocksOfLine = new Map();
        for (let b = 0; b < line.length; ++b) {
            if (!line[b]) continue;
            const blocks = this.blocksOfLine.get(line[b]);
            if (blocks) blocks.push(b);
            else this.blocksOfLine.set(line[b], [b]);
        }
        const count = this.count();
        this.spacer.style.height = `${count * kRowPx}px`;
        this.title.textContent = count
            ? `${header.program ?? 'program'} \u00b7 ${header.dialect} \u00b7 ${count.toLocaleString('en').replace(/,/g, '\u202f')} lines${header.shortened ? ` \u00b7 ${header.shortened}` : ''}`
            : 'No program was written for this run.';
    }

    private count(): number {
        return Math.max(this.lines.length - 1, 0);
    }

    /** Goes to the block of a line; of several the one nearest in time to the present one. */
    private choose(line: number): void {
        const { program } = this;
        if (!program) return;
        let blocks = this.blocksOfLine.get(line);
        for (let next = line + 1; !blocks && next <= this.count(); ++next) {
            blocks = this.blocksOfLine.get(next);
        }
        if (!blocks) return;
        const now = program.fibre.time[this.block];
        const off = (b: number) => Math.abs(program.fibre.time[b] - now);
        this.onSeek(
            program,
            blocks.reduce((best, b) => (off(b) < off(best) ? b : best)),
        );
    }

    private centre(): void {
        if (this.current > 0) {
            const top = (this.current - 1) * kRowPx;
            const { scrollTop, clientHeight } = this.host;
            const inSight = top >= scrollTop + kRowPx && top <= scrollTop + clientHeight - 2 * kRowPx;
            if (!inSight) this.host.scrollTop = top - clientHeight / 2;
        }
        this.draw();
    }

    private draw(): void {
        if (!this.host.clientHeight) return;
        const first = Math.max(Math.floor(this.host.scrollTop / kRowPx) - kBeyond, 0);
        const room = Math.ceil(this.host.clientHeight / kRowPx) + 2 * kBeyond;
        const last = Math.min(first + room, this.count());
        const text = this.program?.fibre.text ?? new Uint8Array(0);
        let html = '';
        for (let i = first; i < last; ++i) {
            const raw = this.decoder.decode(text.subarray(this.lines[i], this.lines[i + 1] - 1));
            const here = i + 1 === this.current;
            const kind = /^\s*[(;]/.test(raw) ? ' remark' : '';
            html +=
                `<div class="row${kind}${here ? ' here' : ''}" data-line="${i + 1}" role="option" ` +
                `aria-selected="${here}"><span class="no">${i + 1}</span><code>${escapeHtml(raw)}</code></div>`;
        }
        this.rows.style.transform = `translateY(${first * kRowPx}px)`;
        this.rows.innerHTML = html;
    }
}
