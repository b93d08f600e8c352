# SPDX-License-Identifier: MIT
# --sessions lists kept sessions; damaged files have a line each, and other
# files are left alone.
XDG_STATE_HOME=$PWD/state
export XDG_STATE_HOME
run --sessions
run --sessions=1
folder=state/glim/sessions
echo "something else" >$folder/0123456789abcdef.session
echo "glim session 1" >$folder/fedcba9876543210.session
touch -d '-1 minute' $folder/fedcba9876543210.session
echo "not a session" >$folder/notes.session
glim --sessions | sed "s|$PWD|PWD|"
touch -d '-31 days' $folder/*
run --sessions
ls $folder
glim --sessions 2>&1 >/dev/full
XDG_STATE_HOME=/dev/null/no HOME=/dev/null/no run --sessions
