// Units with other flags in one program: every one of them draws the same bytes.
#include <cstdio>
#include <vector>

std::vector<float> plain();
std::vector<float> debug();
std::vector<float> native();
std::vector<float> alone();

int main() {
    const std::vector<float> expected = alone();
    const bool same = plain() == expected && debug() == expected && native() == expected;
    std::puts(same ? "Every unit draws the same bytes." : "A unit draws other bytes.");
    return same && !expected.empty() ? 0 : 1;
}
