#!/bin/bash
# cost: 300
# 200 runs killed with -9 at random moments: see test_restart_kill.sh.
exec bash "$(dirname "$0")/test_restart_kill.sh" "$1" 200
