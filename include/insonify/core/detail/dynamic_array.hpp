// An array that grows, for the library's own working data.
//
// std::vector serves the public types. Each of its instantiations compiles some fifteen functions, and the library has
// forty element types of its own: with vectors throughout, the README's twenty lines took a quarter longer to compile
// without optimization. This array has the members that the library uses, as plain loops.
#pragma once

#include <insonify/core/detail/array_bytes.hpp>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <initializer_list>
#include <new>
#include <span>
#include <type_traits>
#include <utility>

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail {

/// Members behave like those of std::vector with the same names, except where noted; `append` inserts a range at the
/// end.
template <class T>
class dynamic_array {
  public:
    using value_type = T;  ///< spans of libc++ 14 are deduced from it

    INSONIFY_MEMBER dynamic_array() noexcept {}
    INSONIFY_MEMBER explicit dynamic_array(std::size_t count) : dynamic_array() { resize(count); }
    INSONIFY_MEMBER dynamic_array(std::size_t count, const T& value) : dynamic_array() { assign(count, value); }
    INSONIFY_MEMBER explicit dynamic_array(std::span<const T> values) : dynamic_array() { append(values); }
    INSONIFY_MEMBER dynamic_array(std::initializer_list<T> values)
        : dynamic_array(std::span<const T>(values.begin(), values.size())) {}
    INSONIFY_MEMBER dynamic_array(const dynamic_array& other)
        : dynamic_array(std::span<const T>(other.data_, other.size_)) {}
    INSONIFY_MEMBER dynamic_array(dynamic_array&& other) noexcept { swap(other); }
    INSONIFY_MEMBER dynamic_array& operator=(dynamic_array other) noexcept {
        swap(other);
        return *this;
    }
    INSONIFY_TAGGED ~dynamic_array() {
        shrink(0);
        deallocate(data_);
    }

    /// @throws std::bad_alloc
    INSONIFY_TAGGED void reserve(std::size_t count) {
        if (count <= capacity_) return;
        T* const moved = allocate(count);
        if constexpr (std::is_trivially_copyable_v<T>) {
            if (size_ > 0) std::memcpy(static_cast<void*>(moved), data_, size_ * sizeof(T));
        } else {
            for (std::size_t i = 0; i < size_; ++i) {
                ::new (static_cast<void*>(moved + i)) T(std::move(data_[i]));
                data_[i].~T();
            }
        }
        deallocate(data_);
        data_ = moved;
        capacity_ = count;
    }
    /// New elements are value-initialized.
    INSONIFY_TAGGED void resize(std::size_t count) {
        if (count < size_) return shrink(count);
        make_room(count);
        construct_to(count);
    }
    /// @pre `value` is not an element of this array
    INSONIFY_TAGGED void assign(std::size_t count, const T& value) {
        shrink(0);
        reserve(count);
        construct_to(count, value);
    }
    /// @pre `values` are not elements of this array
    INSONIFY_TAGGED void append(std::span<const T> values) {
        make_room(size_ + values.size());
        if constexpr (std::is_trivially_copyable_v<T>) {
            if (!values.empty()) std::memcpy(static_cast<void*>(data_ + size_), values.data(), values.size_bytes());
            size_ += values.size();
        } else {
            for (const T& value : values) {
                ::new (static_cast<void*>(data_ + size_)) T(value);
                ++size_;
            }
        }
    }
    INSONIFY_TAGGED void push_back(T value) {
        make_room(size_ + 1);
        ::new (static_cast<void*>(data_ + size_)) T(std::move(value));
        ++size_;
    }
    INSONIFY_MEMBER void pop_back() { shrink(size_ - 1); }
    INSONIFY_MEMBER void clear() { shrink(0); }
    INSONIFY_MEMBER void swap(dynamic_array& other) noexcept {
        std::swap(data_, other.data_);
        std::swap(size_, other.size_);
        std::swap(capacity_, other.capacity_);
    }

    INSONIFY_MEMBER T* data() { return data_; }
    INSONIFY_MEMBER const T* data() const { return data_; }
    INSONIFY_MEMBER std::size_t size() const { return size_; }
    INSONIFY_MEMBER bool empty() const { return size_ == 0; }
    INSONIFY_MEMBER T* begin() { return data_; }
    INSONIFY_MEMBER T* end() { return data_ + size_; }
    INSONIFY_MEMBER const T* begin() const { return data_; }
    INSONIFY_MEMBER const T* end() const { return data_ + size_; }
    INSONIFY_MEMBER T& operator[](std::size_t i) { return data_[i]; }
    INSONIFY_MEMBER const T& operator[](std::size_t i) const { return data_[i]; }
    INSONIFY_MEMBER T& front() { return data_[0]; }
    INSONIFY_MEMBER const T& front() const { return data_[0]; }
    INSONIFY_MEMBER T& back() { return data_[size_ - 1]; }
    INSONIFY_MEMBER const T& back() const { return data_[size_ - 1]; }

  private:
    static_assert(std::is_nothrow_move_constructible_v<T>);

    /// GLM's aligned types need more than the default alignment.
    static constexpr bool is_overaligned = alignof(T) > __STDCPP_DEFAULT_NEW_ALIGNMENT__;
    INSONIFY_MEMBER static T* allocate(std::size_t count) {
        const std::size_t bytes = array_bytes<T>(count);
        if constexpr (is_overaligned) return static_cast<T*>(::operator new (bytes, std::align_val_t{alignof(T)}));
        return static_cast<T*>(::operator new(bytes));
    }
    INSONIFY_MEMBER static void deallocate(T* elements) {
        if constexpr (is_overaligned)
            ::operator delete (elements, std::align_val_t{alignof(T)});
        else
            ::operator delete(elements);
    }

    /// At least doubles the capacity where it has to grow, so that appending takes constant time on average.
    INSONIFY_MEMBER void make_room(std::size_t count) {
        if (count > capacity_) reserve((std::max)(count, 2 * capacity_));
    }
    template <class... From>
    INSONIFY_TAGGED void construct_to(std::size_t count, const From&... from) {
        T* const elements = data_;
        for (std::size_t i = size_; i < count; ++i) {
            ::new (static_cast<void*>(elements + i)) T(from...);
            if constexpr (!std::is_trivially_destructible_v<T>) size_ = i + 1;  // destroyed if a later one throws
        }
        size_ = count;
    }
    INSONIFY_TAGGED void shrink(std::size_t count) {
        if constexpr (std::is_trivially_destructible_v<T>)
            size_ = count;
        else
            while (size_ > count) data_[--size_].~T();
    }

    T* data_ = nullptr;
    std::size_t size_ = 0;
    std::size_t capacity_ = 0;
};

}  // namespace detail
}  // namespace INSONIFY_ABI
}  // namespace insonify
