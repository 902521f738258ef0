#pragma once
// Arrays of the CPU solver: one value a slot (sim/cpu_layout.h).

#include "base/check.h"

#include <glm/glm.hpp>
#include <hwy/aligned_allocator.h>

#include <algorithm>
#include <cstddef>

namespace serosa::sim {

/// Aligned for the vectors, zero at first.
template <class T>
class SlotArray {
public:
    explicit SlotArray(std::size_t size) : data_(hwy::AllocateAligned<T>(size)) {
        SEROSA_CHECK(data_, "memory for the state");
        std::fill_n(data_.get(), size, T(0));
    }
    T* get() const { return data_.get(); }
    T& operator[](std::size_t slot) const { return data_[slot]; }

private:
    hwy::AlignedFreeUniquePtr<T[]> data_;
};

/// Three coordinates, one array each.
struct VectorArray {
    SlotArray<float> axis[3];
    explicit VectorArray(std::size_t size)
        : axis{SlotArray<float>(size), SlotArray<float>(size), SlotArray<float>(size)} {}
    void set(std::size_t slot, const glm::vec3& value) const {
        for (int i = 0; i < 3; ++i)
            axis[i][slot] = value[i];
    }
    glm::vec3 get(std::size_t slot) const { return {axis[0][slot], axis[1][slot], axis[2][slot]}; }
};

} // namespace serosa::sim
