# Sourced by the other scripts: sees to what Bevy needs from the system to build and to run.

# Software renderers report an error where this isn't set, though they draw all the same.
export XDG_RUNTIME_DIR="${XDG_RUNTIME_DIR:-/tmp}"

debian_packages=(
    # Rust links with the C compiler.
    gcc libc6-dev
    # Draws, on the processor if there is no graphics card.
    libvulkan1 mesa-vulkan-drivers
    # Loaded when a window opens.
    libx11-xcb1 libxi6 libxcursor1 libxkbcommon-x11-0
)

install_system_packages() {
    # macOS and Windows bring all of this along.
    [[ "$(uname -s)" == Linux ]] || return 0
    if ! command -v apt-get >/dev/null || ! command -v dpkg >/dev/null; then
        echo "Bevy needs some system packages. On Debian they are called: ${debian_packages[*]}"
        return 0
    fi

    local package missing=()
    for package in "${debian_packages[@]}"; do
        if [[ "$(dpkg-query --show --showformat='${Status}' "$package" 2>/dev/null)" != "install ok installed" ]]; then
            missing+=("$package")
        fi
    done
    ((${#missing[@]} > 0)) || return 0

    echo "Installing system packages: ${missing[*]}"
    if ! as_root apt-get update || ! as_root apt-get install --yes --no-install-recommends "${missing[@]}"; then
        echo "Could not install them; going on without." >&2
    fi
}

as_root() {
    if ((EUID == 0)); then
        DEBIAN_FRONTEND=noninteractive "$@"
    elif command -v sudo >/dev/null; then
        sudo DEBIAN_FRONTEND=noninteractive "$@"
    else
        echo "Neither root nor sudo." >&2
        return 1
    fi
}

require_rust() {
    if ! command -v cargo >/dev/null; then
        echo "Rust is missing: see https://rustup.rs" >&2
        exit 1
    fi
}
