# Sourced by the tools: finds or installs build dependencies.
#
#   need <name>...   checks dependencies; installs missing ones on Debian and Ubuntu, lists their packages elsewhere
#   build_options    sets the array `generator` to CMake options for ninja and ccache, and the number of parallel jobs
#   build_programs <target>...   builds programs of examples/ in build/generate; sets `programs` to their folder
#   choose_python <modules>      sets `python` to one that can import them: the distribution's, if python3 can't
#   explain "$@"     prints the comment at the top of the tool, and $options_file, and exits, if --help is among the words
#   accept "$@"      exits with an error for an option that --help does not name
#   refuse <word>    exits with an error for a word that is not an option
#   fail <message>   exits with an error

set -u -o pipefail
export LC_ALL=C

# name        probe                                   Debian, Ubuntu        Fedora              macOS (Homebrew)
requirements='
g++           command:g++                             g++                   gcc-c++             gcc
cmake         command:cmake                           cmake                 cmake               cmake
ninja         command:ninja|make                      ninja-build           ninja-build         ninja
make          command:make                            make                  make                make
python        command:python3                         python3               python3             python
glm           header:glm/vec3.hpp                     libglm-dev            glm-devel           glm
catch2        header:catch2/catch_all.hpp|catch2/catch.hpp  catch2          catch-devel         catch2
stb           header:stb/stb_image_write.h|stb_image_write.h  libstb-dev    stb-devel           stb
gtest         header:gmock/gmock.h                    libgmock-dev          gmock-devel         googletest
cli11         header:CLI/CLI.hpp                      libcli11-dev          cli11-devel         cli11
json          header:nlohmann/json.hpp                nlohmann-json3-dev    json-devel          nlohmann-json
openssl       header:openssl/evp.h                    libssl-dev            openssl-devel       openssl
archive       header:archive.h                        libarchive-dev        libarchive-devel    libarchive
png           header:png.h                            libpng-dev            libpng-devel        libpng
slurm         command:slurmctld                       slurm-wlm             slurm               -
munge         command:munged                          munge                 munge               -
parallel      command:parallel                        parallel              parallel            parallel
deflate       header:libdeflate.h                     libdeflate-dev        libdeflate-devel    libdeflate
opencv        header:opencv4/opencv2/ml.hpp|opencv2/ml.hpp  libopencv-dev   opencv-devel        opencv
pillow        python:PIL                              python3-pil           python3-pillow      pillow
skimage       python:skimage                          python3-skimage       python3-scikit-image  scikit-image
sklearn       python:sklearn                          python3-sklearn       python3-scikit-learn  scikit-learn
chromium      command:chromium|chromium-browser|google-chrome  chromium     chromium            --cask chromium
clang         command:clang++                         clang                 clang               llvm
fuzzer        clang:-fsanitize=fuzzer                 libclang-rt-dev       compiler-rt         llvm
egl           header:EGL/egl.h                        libegl-dev            mesa-libEGL-devel   mesa
gles          header:GLES3/gl3.h                      libgles-dev           mesa-libGLES-devel  mesa
llvmpipe      library:dri/swrast_dri.so               libgl1-mesa-dri       mesa-dri-drivers    mesa
embree        header:embree4/rtcore.h|embree3/rtcore.h  libembree-dev     embree-devel        embree
g++-11        command:g++-11                          g++-11                -                   gcc@11
libcxx        library:llvm-*/lib/libc++.so            libc++-dev            libcxx-devel        -
libcxxabi     library:llvm-*/lib/libc++abi.so         libc++abi-dev         libcxxabi-devel     -
i386          command:i686-linux-gnu-g++              g++-i686-linux-gnu    -                   -
aarch64       command:aarch64-linux-gnu-g++           g++-aarch64-linux-gnu gcc-c++-aarch64-linux-gnu  -
s390x         command:s390x-linux-gnu-g++             g++-s390x-linux-gnu   gcc-c++-s390x-linux-gnu  -
qemu          command:qemu-s390x                      qemu-user             qemu-user           -
emscripten    command:em++                            emscripten            emscripten          emscripten
mingw         command:x86_64-w64-mingw32-g++-posix    g++-mingw-w64-x86-64-posix  mingw64-gcc-c++  mingw-w64
wine          command:wine                            wine                  wine                wine
valgrind      command:valgrind                        valgrind              valgrind            valgrind
debhelper     command:dh                              debhelper             -                   -
gdb           command:gdb                             gdb                   gdb                 gdb
doxygen       command:doxygen                         doxygen               doxygen             doxygen
clang-format  command:clang-format                    clang-format          clang-tools-extra   clang-format
'

options_file=''  # text of the options of a program that the tool builds
usage() {
    sed -n '2,/^[^#]/s/^# \{0,1\}//p' "tools/$(basename "$0")"
    [ -z "$options_file" ] || cat "$options_file"
}

explain() {
    local word
    for word in "$@"; do
        case $word in -h | --help) usage && exit 0 ;; esac
    done
}

fail() {
    echo "tools/$(basename "$0"): $1" >&2
    exit 2
}

known_options() {
    usage | grep -oE -- '--[a-z][a-z-]*' | sort -u
}

# Prints the known option closest to a word, within two edits (Levenshtein); ties go to the longer common prefix.
similar() {
    known_options | awk -v word="$1" '
        BEGIN { least = 3 }
        {
            for (j = 0; j <= length($0); ++j) row[j] = j
            for (i = 1; i <= length(word); ++i) {
                diagonal = row[0]
                row[0] = i
                for (j = 1; j <= length($0); ++j) {
                    edits = diagonal + (substr(word, i, 1) != substr($0, j, 1))
                    diagonal = row[j]
                    if (row[j] + 1 < edits) edits = row[j] + 1
                    if (row[j - 1] + 1 < edits) edits = row[j - 1] + 1
                    row[j] = edits
                }
            }
            for (alike = 0; alike < length(word) && substr(word, 1, alike + 1) == substr($0, 1, alike + 1);) ++alike
            edits = row[length($0)] - alike / 100
            if (row[length($0)] < 3 && edits < least) { least = edits; best = $0 }
        }
        END { print best }'
}

refuse() {
    local near
    near=$(similar "$1")
    if [ "$near" ]; then fail "$1 is not an option; did you mean $near? --help lists all"; fi
    fail "$1 is not an option; --help lists them"
}

accept() {
    local word known
    known=$(known_options)
    for word in "$@"; do
        case $word in
            --) return ;;
            *" "*) ;;  # a value
            --*) grep -qxF -e "${word%%=*}" <<<"$known" || refuse "${word%%=*}" ;;
            -[a-zA-Z]*) refuse "$word" ;;
        esac
    done
}

# Whether one of the alternatives `a|b` of a probe is present.
present() {
    local kind=${1%%:*} candidates=${1#*:} candidate prefix
    for candidate in ${candidates//|/ }; do
        case $kind in
            command) command -v "$candidate" >/dev/null && return 0 ;;
            python) python3 -c "import $candidate" 2>/dev/null && return 0
                /usr/bin/python3 -c "import $candidate" 2>/dev/null && return 0 ;;
            clang) # links a program with the flag; libFuzzer provides main()
                echo 'extern "C" int LLVMFuzzerTestOneInput(const char*, unsigned long) { return 0; }' |
                    clang++ "$candidate" -x c++ - -o /dev/null 2>/dev/null && return 0
                ;;
            library)
                compgen -G "/usr/lib*/$candidate" >/dev/null && return 0
                compgen -G "/usr/lib*/*/$candidate" >/dev/null && return 0
                ;;
            *)
                for prefix in /usr /usr/local /opt/homebrew /opt/local ${CMAKE_PREFIX_PATH:+${CMAKE_PREFIX_PATH//[:;]/ }}; do
                    [ -e "$prefix/include/$candidate" ] && return 0
                done
                ;;
        esac
    done
    return 1
}

# Prints the rows of `requirements` for named dependencies that are missing.
missing() {
    local name probe packages
    while read -r name probe packages; do
        case " $* " in *" $name "*) present "$probe" || echo "$name $probe $packages" ;; esac
    done <<<"$requirements"
}

# Installs Debian packages as root or by sudo; updates the package lists only if that fails.
install_debian() {
    local root=()
    [ "$(id -u)" = 0 ] || root=(sudo)
    local install=("${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "$@")
    echo "Installing: $*"
    "${install[@]}" || { "${root[@]}" apt-get update && "${install[@]}"; }
}

need() {
    local rows
    rows=$(missing "$@")
    [ -n "$rows" ] || return 0
    if command -v apt-get >/dev/null; then
        # shellcheck disable=SC2046 # one package a word
        install_debian $(awk '{print $3}' <<<"$rows") >&2
        rows=$(missing "$@")
        [ -n "$rows" ] || return 0
    fi
    {
        echo "Missing dependencies, and their packages:"
        awk '{printf "  %-13s Debian, Ubuntu: %-20s Fedora: %-18s Homebrew: %s\n", $1, $3, $4, $5}' <<<"$rows"
    } >&2
    return 1
}

build_options() {
    generator=()
    if command -v ninja >/dev/null; then generator=(-G Ninja); fi
    if command -v ccache >/dev/null; then generator+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
    CMAKE_BUILD_PARALLEL_LEVEL=${CMAKE_BUILD_PARALLEL_LEVEL:-$(getconf _NPROCESSORS_ONLN)}
    CTEST_PARALLEL_LEVEL=${CTEST_PARALLEL_LEVEL:-$CMAKE_BUILD_PARALLEL_LEVEL}
    export CMAKE_BUILD_PARALLEL_LEVEL CTEST_PARALLEL_LEVEL CTEST_OUTPUT_ON_FAILURE=1
}

build_programs() {
    need g++ cmake ninja glm stb cli11 json openssl archive png || exit 1
    build_options
    local build=$PWD/build/generate
    cmake --preset release --log-level=NOTICE -B "$build" "${generator[@]}" -DCMAKE_CXX_COMPILER=g++ \
        -DINSONIFY_BUILD_TESTS=OFF >&2 && cmake --build "$build" --target "$@" >&2 || exit 1
    programs=$build/examples
}

choose_python() {
    python=python3
    "$python" -c "import $1" 2>/dev/null || python=/usr/bin/python3
}
