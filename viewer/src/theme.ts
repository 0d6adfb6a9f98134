/** Light and dark: as the system has it until the button says otherwise; light on paper. */

export type Theme = 'light' | 'dark';

export class ThemeSwitch {
    onChange: (theme: Theme) => void = () => {};
    private chosen: Theme | null = null;
    private readonly media = matchMedia('(prefers-color-scheme: dark)');
    private printing = false;

    constructor(button: HTMLElement) {
        this.media.addEventListener('change', () => this.apply());
        button.addEventListener('click', () => {
            this.chosen = this.theme() === 'dark' ? 'light' : 'dark';
            this.apply();
        });
        window.addEventListener('beforeprint', () => this.print(true));
        window.addEventListener('afterprint', () => this.print(false));
        matchMedia('print').addEventListener('change', (event) => this.print(event.matches));
        document.documentElement.dataset.theme = this.theme();
    }

    theme(): Theme {
        if (this.printing) return 'light';
        return this.chosen ?? (this.media.matches ? 'dark' : 'light');
    }

    private print(on: boolean): void {
        if (on === this.printing) return;
        this.printing = on;
        this.apply();
    }

    private apply(): void {
        document.documentElement.dataset.theme = this.theme();
        this.onChange(this.theme());
    }
}

export function cssVariable(name: string): string {
    return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}
