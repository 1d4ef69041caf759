# Part of test_extremes.sh and test_trade.sh: counts in `missed` what did not come out; the last output is in the file `said`.
missed=0
must() { # what, then a command that must succeed
    local what=$1
    shift
    if "$@"; then echo "passed  $what"; else echo "MISSED  $what" && missed=$((missed + 1)); fi
}
says() { # status, pattern, command ...: it ends so, and says so
    local status=$1 pattern=$2
    shift 2
    "$@" >said 2>&1
    local got=$?
    [ $got -eq "$status" ] && grep -Eq "$pattern" said || { echo "        exit $got"; sed 's/^/        /' said; return 1; }
}
