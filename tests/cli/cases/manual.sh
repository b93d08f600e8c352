# SPDX-License-Identifier: MIT
# --help and the manual page name the same options.
glim --help | sed -n 's/^  \(-[^ []*\).*/\1/p' | sort >help
sed -n 's/^\.It Fl \(-\{0,1\}[a-z-]*\).*/-\1/p' "$root/man/glim.1" |
    sort >manual
diff help manual && echo "the same $(wc -l <help) options"
