# Sourced by ./play, ./test, lab/run and .ci/run: goes to the project's root, installs what is missing where apt is, and sets `features`
# to what can be built here.
cd "$(dirname "${BASH_SOURCE[0]}")/.."
export CARGO_TARGET_DIR="${LENSRUNNER_TARGET:-${XDG_CACHE_HOME:-$HOME/.cache}/lensrunner/target}"
# Without it the window system's library prints errors that mean nothing here.
export XDG_RUNTIME_DIR="${XDG_RUNTIME_DIR:-/tmp}"

has_vulkan() { [ "$(uname)" != Linux ] || compgen -G "/usr/share/vulkan/icd.d/*.json" >/dev/null || compgen -G "/etc/vulkan/icd.d/*.json" >/dev/null; }
# The headers of a library, found as its build script finds them.
has_headers() { [ "$(uname)" != Linux ] || { command -v pkg-config >/dev/null && pkg-config --exists "$1"; }; }

# Installs Debian's packages where there are such and a program is not there; whoever needs it says what it misses.
install_missing() {
  local program="$1" sudo=""
  shift
  ! command -v "$program" >/dev/null && command -v apt-get >/dev/null || return 0
  [ "$(id -u)" = 0 ] || sudo=sudo
  echo "Installing $*" >&2
  { $sudo apt-get update -qq && $sudo apt-get install -y -qq --no-install-recommends "$@"; } >/dev/null || true
}

missing=()
# Any Vulkan driver will do; the software driver is installed where there is none.
has_vulkan || missing+=(mesa-vulkan-drivers libvulkan1)
has_headers alsa || missing+=(pkg-config libasound2-dev)
has_headers libudev || missing+=(pkg-config libudev-dev)
[ ${#missing[@]} -eq 0 ] || install_missing "" "${missing[@]}"

with=lensrunner/game
if has_headers alsa; then with+=,lensrunner/sound; else echo "Built without sound: the ALSA headers (libasound2-dev) are missing." >&2; fi
if has_headers libudev; then with+=,lensrunner/pad; else echo "Built without gamepads: the udev headers (libudev-dev) are missing." >&2; fi
features=(--no-default-features --features "$with")

command -v cargo >/dev/null || { echo "Rust is missing: install it from https://rustup.rs" >&2; exit 1; }
