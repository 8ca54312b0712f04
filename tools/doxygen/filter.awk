# Doxygen's input filter: replaces the inline namespaces by a group for the folder, so that names read as users write them
# (insonify::render) and the reference is grouped by folder.
FNR == 1 {
    module = FILENAME
    sub(/.*insonify\//, "", module)
    module = module ~ /\// ? substr(module, 1, index(module, "/") - 1) : "core"
}
/^inline namespace INSONIFY_ABI \{$/ { print "/** @addtogroup " module " \\ilinebr @{ */"; next }
/^inline namespace INSONIFY_[A-Z_]+ \{\}?$/ { print ""; next }
/^\} +\/\/ (inline )?namespace INSONIFY_ABI$/ { print "/** @} */"; next }
/^\} +\/\/ (inline )?namespace INSONIFY_[A-Z_]+$/ { print ""; next }
{ print }
