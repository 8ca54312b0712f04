# Completes the options of tools/generate, generate_dataset and tools/test in bash: source tools/completion.bash
#
# The tests compare the options with those in examples/generate_dataset/options.cpp.

_insonify_generate() {
    local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} values=
    COMPREPLY=()
    case $before in
        --recipe) values="sonar published" ;;
        --mode) values="overhead ground_range slant_range" ;;
        --match) values="masked whole" ;;
        --mesh-up) values="y z" ;;
        --place) values="third anywhere" ;;
        --colormap) values="gray copper" ;;
        --format) values="png16 npy pfm webdataset" ;;
        --noise) values="none speckle gaussian poisson rayleigh seabed" ;;
        --seabeds) values="ripples mud rock sand mixed heightmap" ;;
        --targets) values="cylinder cube cone sphere ship plane truncated_cone wedge tyre pipe boulder crate lobster_pot" ;;
        --out | --reference | --heightmap | --plan | --config) COMPREPLY=($(compgen -f -- "$current")) && return ;;
    esac
    if [ "$values" ]; then
        # Lists are written with commas: only the last word is completed.
        local done=
        [[ $current == *,* ]] && done=${current%,*},
        COMPREPLY=($(compgen -P "$done" -W "$values" -- "${current##*,}"))
    elif [[ $current == -* ]]; then
        COMPREPLY=($(compgen -W "
            --altitude --aspect --aspects --beam --burial --chip --colormap --config --count --demo --distance
            --dry-run --empty --first --format --grazing --heightmap --heightmap-scale --heightmap-spacing --help
            --input-limit --intensity --match --mesh --mesh-up --mode --noise --out --per-class --pixels --place
            --plan --preview --recipe --reference --reflectivity --seabeds --seed --shard --size --sky --target-size
            --targets --threads --tilt --verify --visible-share" -- "$current"))
    fi
}
_insonify_test() {
    COMPREPLY=($(compgen -W "--ci --full" -- "${COMP_WORDS[COMP_CWORD]}"))
}

complete -o default -F _insonify_generate generate_dataset tools/generate ./tools/generate insonify/tools/generate
complete -o default -F _insonify_test tools/test ./tools/test
