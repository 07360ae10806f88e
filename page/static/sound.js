// The thread that makes the sound: the game's mixer, in blocks of 128 samples, whatever the page's own thread does.
class Sound extends AudioWorkletProcessor {
  constructor({ processorOptions: { program } }) {
    super();
    const module = new WebAssembly.Module(program);
    // It asks nothing of the page; what the compiler left among the imports is never called.
    const imports = {};
    for (const { module: from, name, kind } of WebAssembly.Module.imports(module)) {
      if (kind === "function") (imports[from] ??= {})[name] = () => 0;
    }
    this.mixer = new WebAssembly.Instance(module, imports).exports;
    this.mixer.begin(sampleRate);
    this.port.onmessage = ({ data }) => {
      data.forEach((value, place) => this.mixer.number(place, value));
      this.mixer.hear();
    };
  }

  process(_, [[left, right]]) {
    const at = this.mixer.fill();
    const samples = new Float32Array(this.mixer.memory.buffer, at, 2 * left.length);
    for (let i = 0; i < left.length; i++) {
      left[i] = samples[2 * i];
      if (right) right[i] = samples[2 * i + 1];
    }
    return true;
  }
}

registerProcessor("sound", Sound);
