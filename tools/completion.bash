# Completes the options of the generator, of the example programs and of tools/ in bash: source tools/completion.bash
#
# A test compares the generator's with examples/generate_dataset/options.cpp. Those of built programs come from their --help.

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
        --display) values="amplitude power decibels" ;;
        --format) values="png16 npy pfm webdataset" ;;
        --noise) values="none speckle gaussian poisson rayleigh seabed" ;;
        --seabeds) values="ripples mud rock sand mixed heightmap" ;;
        --targets) values="cylinder cube cone sphere ship plane truncated_cone wedge tyre pipe boulder crate lobster_pot" ;;
        --out | --reference | --heightmap | --plan | --config) COMPREPLY=($(compgen -f -- "$current")) && return ;;
    esac
    if [ "$values" ]; then
        # Lists are separated by commas: complete the last item.
        local done=
        [[ $current == *,* ]] && done=${current%,*},
        COMPREPLY=($(compgen -P "$done" -W "$values" -- "${current##*,}"))
    elif [[ $current == -* ]]; then
        COMPREPLY=($(compgen -W "
            --altitude --aspect --aspects --beam --burial --chip --colormap --config --count --demo --display
            --display-range --distance --dry-run --empty --first --format --grazing --heightmap --heightmap-scale
            --heightmap-spacing --help --input-limit --intensity --match --mesh --mesh-up --mode --noise --out
            --per-class --pixels --place --plan --preview --recipe --reference --reflectivity --seabeds --seed
            --shard --size --sky --target-size --targets --threads --tilt --verify --visible-share --white" -- "$current"))
    fi
}
# Options of a tool that are listed here.
_insonify_tool() {
    local current=${COMP_WORDS[COMP_CWORD]} options=--help
    COMPREPLY=()
    case ${COMP_WORDS[0]##*/} in
        test) options+=" --ci --full" ;;
        merge) options+=" --preview" ;;
        bench) options+=" --install --workloads --sizes --only --threads --frames --processor-time --json --svg --dump" ;;
        recognize) options+=" --real --counts --recipes --try --sizes --second-simulator --synthetic-test --seeds --threads" ;;
        slurm) options+=" --tasks" ;;
        amalgamate | reference) options+=" --check" ;;
        compile_cost) options+=" --check --record" ;;
        mutants) options+=" --jobs --only --least --record --check" ;;
        tradeoff) options+=" --out --pixels --runs" ;;
    esac
    if [[ $current == -* ]]; then COMPREPLY=($(compgen -W "$options" -- "$current")); fi
}
# Options of a program, by its --help.
_insonify_program() {
    local current=${COMP_WORDS[COMP_CWORD]}
    COMPREPLY=()
    if [[ $current == -* ]]; then
        COMPREPLY=($(compgen -W "$("${COMP_WORDS[0]}" --help 2>/dev/null | grep -oE -- '^ +(-h,)?--[a-z-]+' |
            sed 's/.*--/--/')" -- "$current"))
    fi
}

complete -o default -F _insonify_generate generate_dataset tools/generate ./tools/generate insonify/tools/generate
for _insonify_name in test merge bench recognize slurm amalgamate reference compile_cost mutants tradeoff pictures playground; do
    complete -o default -F _insonify_tool "tools/$_insonify_name" "./tools/$_insonify_name" "insonify/tools/$_insonify_name"
done
unset _insonify_name
complete -o default -F _insonify_program merge_dataset sidescan_survey ping_simulator recognize recognize_real
