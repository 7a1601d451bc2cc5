// SPDX-License-Identifier: MIT
package rhotrack.spy;

import java.awt.Point;
import java.awt.event.MouseAdapter;
import java.awt.event.MouseEvent;
import java.awt.event.MouseWheelEvent;

/**
 * Mouse control of the plan view: the wheel zooms about the pointer, dragging pans, a click selects
 * a track, a double click fits.
 */
final class PointerControl extends MouseAdapter {
    private static final double ZOOM_A_NOTCH = 1.2;

    private final PlanView plan;
    private Point dragged;

    private PointerControl(PlanView plan) {
        this.plan = plan;
    }

    static void attach(PlanView plan) {
        PointerControl control = new PointerControl(plan);
        plan.addMouseListener(control);
        plan.addMouseMotionListener(control);
        plan.addMouseWheelListener(control);
    }

    @Override
    public void mouseWheelMoved(MouseWheelEvent event) {
        plan.zoomAbout(event.getX(), event.getY(),
                Math.pow(ZOOM_A_NOTCH, -event.getPreciseWheelRotation()));
    }

    @Override
    public void mousePressed(MouseEvent event) {
        dragged = event.getPoint();
    }

    @Override
    public void mouseReleased(MouseEvent event) {
        dragged = null;
    }

    @Override
    public void mouseDragged(MouseEvent event) {
        if (dragged != null) {
            plan.pan(event.getX() - dragged.x, event.getY() - dragged.y);
        }
        dragged = event.getPoint();
        plan.setPointer(event.getPoint());
    }

    @Override
    public void mouseClicked(MouseEvent event) {
        if (event.getClickCount() == 2) {
            plan.fit();
        } else {
            plan.selectAt(event.getX(), event.getY());
        }
    }

    @Override
    public void mouseMoved(MouseEvent event) {
        plan.setPointer(event.getPoint());
    }

    @Override
    public void mouseExited(MouseEvent event) {
        plan.setPointer(null);
    }
}
