# SPDX-License-Identifier: Apache-2.0
# Writes every fenced block that names a file, ```cpp crank.cpp, to that file in the folder `folder`.
/^```[a-z]+ [A-Za-z0-9_.]+$/ { file = folder "/" $2; printf "" > file; next }
/^```$/ { file = ""; next }
file != "" { print > file }
