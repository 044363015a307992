#include "gl/vertex_array.h"

namespace tyndall::gl {

VertexArray::VertexArray(std::string_view name, std::span<const VertexAttribute> attributes,
                         GLuint indices) {
    GLuint id = 0;
    glCreateVertexArrays(1, &id);
    object_ = Object(ObjectKind::VertexArray, id);
    object_.label(name);
    GLuint binding = 0;
    for (const VertexAttribute& attribute : attributes) {
        glEnableVertexArrayAttrib(id, attribute.location);
        glVertexArrayVertexBuffer(id, binding, attribute.buffer, GLintptr(attribute.offset),
                                  attribute.stride);
        if (attribute.integer)
            glVertexArrayAttribIFormat(id, attribute.location, attribute.components, attribute.type,
                                       0);
        else
            glVertexArrayAttribFormat(id, attribute.location, attribute.components, attribute.type,
                                      attribute.normalised, 0);
        glVertexArrayAttribBinding(id, attribute.location, binding);
        glVertexArrayBindingDivisor(id, binding, attribute.divisor);
        ++binding;
    }
    if (indices != 0) glVertexArrayElementBuffer(id, indices);
}

} // namespace tyndall::gl
