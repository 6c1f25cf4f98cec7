// The viewer as WebAssembly (viewer/web/main.cpp), on a canvas. Times are performance.now().

const PROGRAM = "/wall/viewer.js"; // beside its viewer.wasm; installed with the daemon
const ATTRIBUTES = { alpha: true, antialias: false, depth: false, stencil: false, premultipliedAlpha: true, powerPreference: "high-performance" } as const;
const EXTENSIONS = ["EXT_color_buffer_float", "OES_texture_float_linear"];
const ASK_AGAIN_MS = 1;
const MEASURED_EVERY = 3; // pictures: to see when one is complete costs a little

/** What emscripten makes of main.cpp. */
interface Program {
  HEAPU8: Uint8Array;
  GL: { registerContext(context: WebGL2RenderingContext, attributes: { majorVersion: number }): number; makeContextCurrent(handle: number): boolean };
  UTF8ToString(text: number): string;
  _malloc(bytes: number): number;
  _free(address: number): void;
  _wall_open(camera: number, scene: number, look: number, is_software: number, is_transparent: number): number;
  _wall_close(): void;
  _wall_take(message: number, bytes: number, now_s: number): number;
  _wall_draw(now_s: number, width_px: number, height_px: number): number;
  _wall_is_drawing(now_s: number): number;
  _wall_pictures(): number;
  _wall_pace(): number;
}

/** What to show: as the viewer's command line has it. */
export interface Wish {
  camera: string;
  scene: string;
  look: string[];
  is_transparent: boolean;
}

export type Trouble = "no program" | "no WebGL" | "lost context" | { reason: string };

const now_s = () => performance.now() / 1000;

export class Viewer {
  private program: Program | null = null;
  private is_open = false;
  private room = { address: 0, bytes: 0 }; // for messages
  private drawn = 0;

  constructor(private readonly canvas: HTMLCanvasElement, private readonly wish: Wish, private readonly trouble: (what: Trouble | null) => void) {
    canvas.addEventListener("webglcontextlost", (event) => {
      event.preventDefault(); // it comes back
      this.close();
      trouble("lost context");
    });
  }

  /** Ready for a stream: loads the program and begins with an empty stage, if it has not. Returns false if it cannot. */
  async open(): Promise<boolean> {
    if (this.is_open) return true;
    try {
      this.program ??= await load();
    } catch {
      this.trouble("no program");
      return false;
    }
    const context = this.canvas.getContext("webgl2", ATTRIBUTES) as WebGL2RenderingContext | null;
    if (context === null || EXTENSIONS.some((name) => context.getExtension(name) === null)) {
      this.trouble("no WebGL");
      return false;
    }
    if (context.isContextLost()) return false;
    const { program } = this;
    program.GL.makeContextCurrent(program.GL.registerContext(context, { majorVersion: 2 }));
    this.is_open = this.fits(this.with_texts([this.wish.camera, this.wish.scene, this.wish.look.join("\n")],
      ([camera = 0, scene = 0, look = 0]) =>
        program._wall_open(camera, scene, look, is_drawn_by_processor(context) ? 1 : 0, this.wish.is_transparent ? 1 : 0)));
    if (this.is_open) this.trouble(null);
    return this.is_open;
  }

  /** Takes a message of the stream. Returns false if the connection is of no use. */
  take(message: ArrayBuffer): boolean {
    if (this.program === null || !this.is_open) return false; // scenes come at the beginning of a stream
    const { program, room } = this;
    if (message.byteLength > room.bytes) {
      program._free(room.address);
      room.address = program._malloc(message.byteLength);
      room.bytes = message.byteLength;
    }
    program.HEAPU8.set(new Uint8Array(message), room.address);
    return this.fits(program._wall_take(room.address, message.byteLength, now_s()));
  }

  /** Draws a picture, if it is time for one. */
  draw(): void {
    if (this.program === null || !this.is_open) return;
    this.is_open = this.fits(this.program._wall_draw(now_s(), this.canvas.width, this.canvas.height));
    const pictures = this.program._wall_pictures();
    if (pictures !== this.drawn && pictures % MEASURED_EVERY === 0) this.watch();
    this.drawn = pictures;
  }

  get pictures(): number {
    return this.program?._wall_pictures() ?? 0;
  }
  get pace(): string {
    return this.program === null ? "" : this.program.UTF8ToString(this.program._wall_pace());
  }

  private close(): void {
    this.is_open = false;
    this.program?._wall_close();
  }

  /** Looks when the picture is complete. */
  private watch(): void {
    if (this.program !== null && this.is_open && this.program._wall_is_drawing(now_s()) !== 0) setTimeout(() => this.watch(), ASK_AGAIN_MS);
  }

  /** Reports a text of the program. Returns true if there is none. */
  private fits(text: number): boolean {
    if (text === 0 || this.program === null) return true;
    this.trouble({ reason: this.program.UTF8ToString(text) });
    return false;
  }

  private with_texts(texts: string[], use: (addresses: number[]) => number): number {
    const { program } = this;
    if (program === null) return 0;
    const addresses = texts.map((text) => {
      const bytes = new TextEncoder().encode(text);
      const address = program._malloc(bytes.length + 1);
      program.HEAPU8.set(bytes, address);
      program.HEAPU8[address + bytes.length] = 0;
      return address;
    });
    const result = use(addresses);
    addresses.forEach((address) => program._free(address));
    return result;
  }
}

async function load(): Promise<Program> {
  const { default: make } = (await import(PROGRAM)) as { default: () => Promise<Program> };
  return make();
}

/** As far as the browser tells pages. */
function is_drawn_by_processor(context: WebGL2RenderingContext): boolean {
  const names = context.getExtension("WEBGL_debug_renderer_info");
  const renderer = String(context.getParameter(names === null ? context.RENDERER : names.UNMASKED_RENDERER_WEBGL));
  return /llvmpipe|softpipe|SwiftShader|Basic Render/i.test(renderer);
}
