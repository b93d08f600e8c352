# SPDX-License-Identifier: MIT
# Kitty's images go through tmux as placeholders, if the terminal outside knows
# them. That terminal is played by the case: it answers the question and reads
# what an inner tmux writes.
lamp_scene
case $(tmux -V) in
"tmux 3."[3-9]* | "tmux "[4-9]*) ;;
*)
    echo "this tmux has no option allow-passthrough"
    exit 77
    ;;
esac
echo 'set -g allow-passthrough on; set -g destroy-unattached on' >inner.conf
inner="env -u TMUX TERM=xterm-256color tmux -u -S $PWD/inner -f $PWD/inner.conf"
placeholder=$(printf '\364\216\273\256')

has_bytes()
{
    grep -qa -e "$1" stream
}

# The inner tmux loses what it should pass on while it draws its window for the
# first time, so glim waits for a key.
begin()
{
    : >stream
    start_line "sleep 1; $inner new-session 'read -r _; $(command -v glim) --glyph kitty lamp.obj'"
    mux pipe-pane "cat >>'$PWD/stream'"
    wait_for "^\[0\] 0:"
    keys Enter
    wait_until has_bytes "_Gi=1,s=1,v=1,a=q,t=d,f=24,U=1;"
}

begin
raw_keys "$(printf '\033_Gi=1;OK\033\\')"
wait_until has_bytes "_Ga=T,f=24,[^;]*,U=1,q=2"
wait_until has_bytes "$placeholder"
keys w
wait_until has_bytes "_Ga=d,d=I,i=[0-9]*,q=2"
keys C-q
expect_end 0
# A terminal without placeholders does not answer.
fresh
begin
wait_for "the terminal reports no kitty pixels"
wait_for "[▀▄]"
keys C-q
expect_end 0
if has_bytes "a=T" || has_bytes "$placeholder"; then
    die "images were sent that the terminal does not show"
fi
