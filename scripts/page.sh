# Sourced by ./web and ./test-web after prepare.sh: finds or makes a compiler for pages (wasm32-unknown-unknown), and gives
#   page_build OPTIONS: builds a library for it, into $page_programs/PROFILE
#   page_host COMMAND: runs page/host, $page_host_program
#   page_make FOLDER: makes the page
page_target=wasm32-unknown-unknown
page_cache="${XDG_CACHE_HOME:-$HOME/.cache}/lensrunner"
page_env=(env CARGO_TARGET_DIR="$CARGO_TARGET_DIR-web")
# Every browser with WebGPU has these.
page_flags="-C target-feature=+simd128"
page_programs="$CARGO_TARGET_DIR-web/$page_target"
page_build() {
  "${page_env[@]}" CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUSTFLAGS="$page_flags" \
    cargo build --locked --profile page --target "$page_target" --lib "$@"
}
# Builds the page into a folder, and says how large it is.
page_make() {
  page_build --package lensrunner_page --package lensrunner_sound
  page_host page --game "$page_programs/page/lensrunner_page.wasm" --sound "$page_programs/page/lensrunner_sound.wasm" \
    --table tables/default.lut --icon assets/package/icon.png --page page/static --prepare page/host/prepare.mjs "$1"
  du -ch "$1"/*.br | tail -n 1 | cut -f1 | sed "s|$|B compressed: $1|" >&2
}
page_host_program="$CARGO_TARGET_DIR-web/release/lensrunner_host"
page_host() {
  CARGO_TARGET_DIR="$CARGO_TARGET_DIR-web" cargo build --quiet --release --locked --manifest-path page/host/Cargo.toml
  "$page_host_program" "$@"
}

# The standard library of the compiler in use.
has_page_library() { [ -d "$(rustc --print sysroot)/lib/rustlib/$page_target/lib" ]; }

if ! has_page_library && command -v rustup >/dev/null; then
  echo "Fetching the standard library for $page_target" >&2
  timeout 300 rustup target add "$page_target" >/dev/null 2>&1 || echo "rustup could not fetch it" >&2
fi
if ! has_page_library; then
  # Debian has a newer compiler with its sources; the library is built from them once.
  install_missing rust-lld rustc-web cargo-web rust-web-src rust-web-llvm lld-22
  [ -x /usr/bin/rustc ] && [ -x /usr/bin/cargo ] || {
    echo "There is no standard library for $page_target: rustup target add $page_target" >&2
    exit 1
  }
  sysroot="$page_cache/sysroot-$(/usr/bin/rustc --version | cut -d' ' -f2)"
  if [ ! -d "$sysroot" ]; then
    echo "Building the standard library for $page_target, once: two minutes" >&2
    work="$(mktemp -d)"
    mkdir -p "$work/src" "$work/sysroot/lib/rustlib/$page_target/lib"
    printf '[package]\nname = "empty"\nedition = "2021"\n[lib]\ncrate-type = ["cdylib"]\n[profile.release]\npanic = "abort"\n[workspace]\n' > "$work/Cargo.toml"
    touch "$work/src/lib.rs"
    (cd "$work" && RUSTC_BOOTSTRAP=1 RUSTC=/usr/bin/rustc CARGO_TARGET_DIR="$work/target" /usr/bin/cargo build --quiet \
      -Zbuild-std=std,panic_abort --target "$page_target" --release)
    cp "$work/target/$page_target/release/deps/"*.rlib "$work/sysroot/lib/rustlib/$page_target/lib/"
    host="$(/usr/bin/rustc -vV | sed -n 's/^host: //p')"
    ln -s "/usr/lib/rustlib/$host" "$work/sysroot/lib/rustlib/"
    mkdir -p "$page_cache"
    mv "$work/sysroot" "$sysroot"
    rm -rf "$work"
  fi
  page_env+=(RUSTC=/usr/bin/rustc)
  page_flags+=" --sysroot $sysroot"
fi
